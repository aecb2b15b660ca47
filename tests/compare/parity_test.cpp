// These tests compare the two pipelines: their hits and their direct light must be equal.

#include "compare/hits/hit_agreement.h"
#include "compare/renderer.h"
#include "raster/render.h"
#include "raytrace/render.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <utility>

using namespace duet;
using namespace duet::compare;

namespace {

namespace fs = std::filesystem;

/// Returns the scenes of models/ and the meshes of the folder DUET_MODELS or the one beside the checkout. Without
/// such a folder there are no meshes.
std::vector<fs::path> all_scenes() {
    std::vector<fs::path> paths;
    const auto collect = [&](const fs::path& folder, const std::string& ending) {
        for (const fs::directory_entry& entry : fs::directory_iterator(folder))
            if (entry.path().extension() == ending && entry.path().stem().extension() != ".schema")
                paths.push_back(entry.path());
    };
    collect(fs::path(DUET_SOURCE_DIR) / "models", ".json");
    const char* const named = std::getenv("DUET_MODELS");
    const fs::path meshes = named != nullptr ? fs::path(named) : fs::path(DUET_SOURCE_DIR) / "../shared/models";
    if (fs::is_directory(meshes))
        collect(meshes, ".obj");
    else
        MESSAGE("no folder ", meshes.string(), " of further meshes: only models/ is tested");
    std::sort(paths.begin(), paths.end());
    return paths;
}

/// Returns the scene's own view, scaled so that its longer side has `side` pixels.
View reduced_view(const Scene& scene, int side) {
    const double scale = static_cast<double>(side) / std::max(scene.width, scene.height);
    const auto pixels = [&](int n) { return std::max(1, static_cast<int>(std::lround(n * scale))); };
    return {scene.camera, pixels(scene.width), pixels(scene.height)};
}

std::string describe(const Hit& hit) {
    return hit.valid() ? message("object ", hit.object, " primitive ", hit.primitive, " t ", hit.t) : "nothing";
}
std::string describe(const ReferenceHit& hit) {
    return hit.valid() ? message("object ", hit.object, " primitive ", hit.primitive, " t ", hit.t) : "nothing";
}

std::string describe(const HitAgreement& agreement) {
    std::string text = message(agreement.pixels, " pixels: ", agreement.edge, " edge, ", agreement.depth_tie,
                               " depth tie, ", agreement.unexplained, " unexplained; worst distance ",
                               agreement.worst_distance, " at (", agreement.worst_x, ", ", agreement.worst_y, ")");
    for (const UnexplainedPixel& p : agreement.listed)
        text += message("\n  pixel (", p.x, ", ", p.y, "): raster sees ", describe(p.raster), ", raytrace ",
                        describe(p.raytrace), ", double precision ", describe(p.exact));
    return text;
}

HitAgreement agreement_of(const Scene& scene, const View& view) {
    Control control;
    const ComparisonSettings settings;
    const Image<Hit> raster = raster_hits(scene, settings)(view, control).hit;
    const Image<Hit> raytrace = raytrace_hits(scene, settings)(view, control).hit;
    return compare_hits(scene, view, raster, raytrace);
}

} // namespace

TEST_SUITE("image") {

    TEST_CASE("in every scene both pipelines see the same primitives at the same distances, or differ for a reason") {
        const std::vector<fs::path> scenes = all_scenes();
        REQUIRE(scenes.size() >= 3);
        for (const fs::path& path : scenes) {
            const Scene scene = load_scene(path);
            const HitAgreement agreement = agreement_of(scene, reduced_view(scene, 300));
            INFO(path.filename().string(), ": ", describe(agreement));
            CHECK(agreement.unexplained == 0);
            CHECK(agreement.distance_violations == 0);
            CHECK(agreement.same > agreement.pixels * 9 / 10); // explained differences are exceptions
        }
    }
}

namespace {

/// Holds sums of radiance over the pixels of one object.
struct LightOnObject {
    Rgbd raster, raytrace, variance;
    int pixels = 0;
};

} // namespace

TEST_SUITE("statistical") {

    // The path tracer's means have a standard error of about 1e-6 here (checked below to be at most a ninth of the
    // tolerance), and the closed form has none. A false alarm is therefore an event of nine standard errors, with
    // odds below 10^-17 for all objects and channels together. A bias of 0.25 % would remain undetected with odds
    // below 2 %, in practice never.
    TEST_CASE("Cornell box: direct light in closed form equals light sampling without visibility") {
        const Scene scene = load_scene(fs::path(DUET_SOURCE_DIR) / "models" / "cornell.json");
        const View view{scene.camera, 96, 96};
        Control control;
        raster::RasterSettings closed;
        closed.environment = closed.shadows = closed.indirect_light = false;
        closed.aovs.hit = true;
        raytrace::PathTracerSettings sampled;
        sampled.integrator = raytrace::Integrator::kUnshadowed;
        sampled.sampler = SamplerKind::kCenter;
        sampled.samples_per_pixel = 1024;
        sampled.environment = false;
        sampled.aovs.hit = sampled.aovs.variance = true;
        const Rendering a = raster::render(raster::prepare(scene, closed), view, closed, control);
        const Rendering b = raytrace::render(raytrace::prepare(scene, sampled), view, sampled, control);

        // Sums are separate for each object and each face, so that errors of opposite sign cannot cancel.
        std::map<std::pair<std::uint32_t, std::uint32_t>, LightOnObject> objects;
        for (std::size_t i = 0; i < a.hit.size(); ++i) {
            if (!a.hit[i].valid() || a.hit[i].object != b.hit[i].object || a.hit[i].primitive != b.hit[i].primitive)
                continue;
            LightOnObject& object = objects[{a.hit[i].object, a.hit[i].primitive}];
            object.raster += Rgbd(a.radiance[i]);
            object.raytrace += Rgbd(b.radiance[i]);
            object.variance += Rgbd(b.variance[i]);
            ++object.pixels;
        }
        CHECK(objects.size() >= 7); // five walls, two blocks, and the light
        constexpr double kTolerance = 0.002;
        int lit = 0;
        for (const auto& entry : objects) {
            const std::string name = message(scene.objects[entry.first.first].name, ", primitive ", entry.first.second);
            const LightOnObject& object = entry.second;
            for (std::size_t c = 0; c < 3; ++c) {
                if (object.raytrace[c] / object.pixels < 1e-6 && object.raster[c] / object.pixels < 1e-6) continue;
                ++lit;
                const double error = object.raster[c] / object.raytrace[c] - 1;
                const double standard_error = std::sqrt(object.variance[c]) / object.raytrace[c];
                CAPTURE(name);
                CAPTURE(c);
                CAPTURE(object.pixels);
                CAPTURE(standard_error);
                CHECK(std::abs(error) <= kTolerance);
                CHECK(9 * standard_error <= kTolerance);
            }
        }
        CHECK(lit >= 15);
    }
}
