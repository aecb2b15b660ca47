// These tests check the ladder with scenes in which only one approximation is wrong, and the ladder command.
#include "compare/ladder/ladder.h"

#include "common/image/image_file.h"
#include "common/system/file.h"
#include "compare/ladder/code_lines.h"
#include "compare/ladder/shares.h"
#include "tests/support/form_factor.h"
#include "tests/raytrace/scene_builder.h"
#include "tests/support/scratch.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <map>

using namespace duet;
using namespace duet::compare;
using duet::test::ScratchFolder;
using nlohmann::json;
using raytrace::quad;
using raytrace::SceneBuilder;

namespace {

namespace fs = std::filesystem;

constexpr int kSize = 48;
constexpr float kAlbedo = 0.6f;

/// Puts the camera straight above the square [−2, 2]² of the plane y = 0, with pixels 1/12 wide.
void look_down(Scene& scene) {
    Camera& camera = scene.camera;
    camera.projection = Camera::Projection::kOrthographic;
    camera.eye = {0, 0.5, 0};
    camera.look_at = {0, 0, 0};
    camera.up = {0, 0, -1};
    camera.height = 4;
}

/// Returns a floor viewed from above, with an optional black square between it and its light. The camera is below the
/// square.
SceneBuilder floor_scene(const Material& material, bool blocker) {
    SceneBuilder builder;
    builder.add(quad({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}), builder.material(material));
    if (blocker) builder.add(quad({-0.5f, 1, 0.5f}, {1, 0, 0}, {0, 0, -1}), builder.material(Diffuse{{Rgb(0)}}));
    look_down(builder.scene);
    return builder;
}

LadderImages ladder_scene(const Scene& scene, int spp = 64, int threads = 0, bool effects = false) {
    ComparisonSettings settings;
    settings.raytrace_spp = spp;
    settings.raster_spp = 64;
    settings.threads = threads;
    PreparedPair pair = prepare_pair(scene, settings);
    pair.raster_settings.shadows = effects; // one approximation at a time
    if (!effects) {
        pair.raster_settings.ambient_occlusion = pair.raster_settings.indirect_light = false;
    }
    Control control;
    const View view{scene.camera, kSize, kSize};
    ImageRgb first = raster::render(pair.raster, view, pair.raster_settings, control).radiance;
    return evaluate_ladder(std::move(first), pair, view, control);
}

double share_of(const Shares& shares, const char* id) {
    for (std::size_t k = 0; k < kRungCount; ++k)
        if (std::string(kRungNames[k].id) == id) return shares.share[k];
    return NAN;
}

/// Returns the sum of the absolute shares of all rungs but the named one. The scene has none of these effects.
double others(const Shares& shares, const char* id) {
    double sum = 0;
    for (std::size_t k = 0; k < kRungCount; ++k)
        if (std::string(kRungNames[k].id) != id) sum += std::abs(shares.share[k]);
    return sum;
}

LadderOptions small_ladder(const fs::path& folder) {
    LadderOptions options;
    options.scene = fs::path(DUET_SOURCE_DIR) / "models" / "cornell.json";
    options.folder = folder;
    options.scene_options.size = {24, 20};
    options.settings.raster_spp = 1;
    options.settings.raytrace_spp = 3;
    options.quiet = true;
    return options;
}

json without_times(json report) {
    report.erase("seconds");
    report.erase("threads");
    for (json& rung : report["rungs"])
        for (json& quantity : rung["quantities"]) quantity.erase("seconds");
    return report;
}

} // namespace

TEST_SUITE("unit") {

    // A point light is 2 above the floor, and a square of side 1 is halfway. Its shadow is a square of side 2, in
    // which D is the whole unshadowed light I cos θ / d² · albedo/π.
    TEST_CASE("where shadows alone are missing their share is 1, and the light they take the closed form's") {
        SceneBuilder builder = floor_scene(Diffuse{{Rgb(kAlbedo)}}, true);
        builder.scene.lights.push_back(PointLight{{0, 2, 0}, Rgb(10)});
        const Scene scene = builder.finish();
        const LadderImages shown_images = ladder_scene(scene, 16);
        const Shares s = shares(shown_images);
        CHECK(std::abs(s.sum - 1) < 1e-12);
        CHECK(share_of(s, "shadows") > 0.999);
        CHECK(others(s, "shadows") < 1e-4);
        const ImageRgb before = shown_images.image(3), after = shown_images.image(4);
        double taken = 0, expected = 0;
        for (int y = 0; y < kSize; ++y)
            for (int x = 0; x < kSize; ++x) {
                const double px = (x + 0.5) / 12 - 2, pz = (y + 0.5) / 12 - 2, d2 = px * px + pz * pz + 4;
                taken += static_cast<double>(before(x, y).g - after(x, y).g);
                if (std::abs(px) < 1 && std::abs(pz) < 1)
                    expected += 10 * 2 / (d2 * std::sqrt(d2)) * static_cast<double>(kAlbedo) / kPiDouble;
            }
        CHECK(taken == doctest::Approx(expected).epsilon(1e-3));
        const CauseMap map = map_causes(shown_images);
        CHECK(map.cause(kSize / 2, kSize / 2) == 3);
        CHECK(map.visible == doctest::Approx(0.25).epsilon(0.01)); // the shadow's fraction of the image
    }

    TEST_CASE("with shadow maps the rungs below are told what they take: the sum stays the light, the error is small") {
        SceneBuilder builder = floor_scene(Diffuse{{Rgb(kAlbedo)}}, true);
        builder.scene.lights.push_back(PointLight{{0, 2, 0}, Rgb(10)});
        const Scene scene = builder.finish();
        const LadderImages with = ladder_scene(scene, 16, 0, true), without = ladder_scene(scene, 16);
        CHECK(with.invalid_samples == 0);
        double before = 0, after = 0, change = 0;
        const ImageRgb last = with.image(kRungCount);
        for (std::size_t i = 0; i < last.size(); ++i) {
            before += sqr(static_cast<double>(without.first[i].g - last[i].g));
            after += sqr(static_cast<double>(with.first[i].g - last[i].g));
            change += std::abs(static_cast<double>(with.image(3)[i].g - with.image(2)[i].g));
        }
        CHECK(after < 0.02 * before); // the remainder is the shadow's edge, blurred over some texels
        // Rung 3 replaces unshadowed light by equal unshadowed light.
        CHECK(change < 1e-3 * static_cast<double>(last.size()));
    }

    // The square hides a fraction of a constant sky from the floor. At the center this fraction is its form factor.
    TEST_CASE("where the environment's occlusion alone is missing its share is 1, and what is hidden the form factor") {
        SceneBuilder builder = floor_scene(Diffuse{{Rgb(kAlbedo)}}, true);
        builder.scene.environment = ConstantEnvironment{Rgb(1.5f)};
        const Scene scene = builder.finish();
        const LadderImages shown_images = ladder_scene(scene, 256);
        const Shares s = shares(shown_images);
        CHECK(std::abs(s.sum - 1) < 1e-12);
        CHECK(share_of(s, "environment") > 0.98);
        CHECK(others(s, "environment") < 1e-3);
        const std::array<Vec3, 4> square = {Vec3(-0.5f, 1, 0.5f), Vec3(0.5f, 1, 0.5f), Vec3(0.5f, 1, -0.5f),
                                            Vec3(-0.5f, 1, -0.5f)};
        const ImageRgb before = shown_images.image(4), after = shown_images.image(5);
        double hidden = 0, expected = 0;
        for (int y = 20; y < 28; ++y)
            for (int x = 20; x < 28; ++x) {
                const Vec3 p(Vec3d((x + 0.5) / 12 - 2, 0, (y + 0.5) / 12 - 2));
                hidden += static_cast<double>(before(x, y).g - after(x, y).g);
                expected +=
                    1.5 * static_cast<double>(kAlbedo) / kPiDouble * polygon_form_factor_times_pi(p, {0, 1, 0}, square);
            }
        // Of 16,384 samples a fifth is occluded, so the standard error is at most 1.6 %, ignoring stratification.
        CHECK(hidden == doctest::Approx(expected).epsilon(0.08));
    }

    TEST_CASE("where a mirror alone is wrong, at the edges of what it shows, reflections have most of the difference") {
        SceneBuilder builder = floor_scene(Metal{{Rgb(0.9f)}, 0}, true);
        builder.scene.environment = ConstantEnvironment{Rgb(1.5f)};
        const Scene scene = builder.finish();
        const LadderImages shown_images = ladder_scene(scene, 16);
        const Shares s = shares(shown_images);
        CHECK(std::abs(s.sum - 1) < 1e-12);
        CHECK(share_of(s, "reflections") > 0.75); // measured: 0.79
        // The mirror shows the square as black with a side of 12 pixels; only its edges are wrong,
        // two pixels wide, as the probe's texels are. Measured: 96 pixels
        CHECK(map_causes(shown_images).visible < 110.0 / (kSize * kSize));
        CHECK(shown_images.image(7)(kSize / 2, kSize / 2).g == 0);
    }

    // The floor and the wall illuminate each other, and nothing occludes the sun.
    TEST_CASE("where indirect light alone is missing its share is 1 but for noise") {
        SceneBuilder builder;
        const std::uint32_t grey = builder.material(Diffuse{{Rgb(kAlbedo)}});
        builder.add(quad({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}), grey);
        builder.add(quad({-4, 0, -2}, {8, 0, 0}, {0, 0.4f, 0}), grey);
        builder.scene.lights.push_back(SunLight{normalize(Vec3(0, -1, -1)), Rgb(2)});
        look_down(builder.scene);
        const Scene scene = builder.finish();
        const Shares s = shares(ladder_scene(scene, 256));
        CHECK(std::abs(s.sum - 1) < 1e-12);
        CHECK(share_of(s, "everything") > 0.9);
        CHECK(others(s, "everything") < 1e-3);
        CHECK(s.share[kNoise] > 0);
    }

    TEST_CASE("where both ways agree there is nothing to explain") {
        SceneBuilder builder = floor_scene(Diffuse{{Rgb(kAlbedo)}}, false);
        builder.scene.lights.push_back(SunLight{normalize(Vec3(0, -1, -1)), Rgb(2)});
        const Scene scene = builder.finish();
        const Shares s = shares(ladder_scene(scene, 4));
        CHECK(s.negligible);
        CHECK(s.sum == 0);
    }

    TEST_CASE("the last image is the path tracer's; for any number of threads the same bits") {
        const Scene scene = load_scene(fs::path(DUET_SOURCE_DIR) / "models" / "cornell.json");
        const LadderImages shown_images = ladder_scene(scene, 8, 1);
        raytrace::PathTracerSettings settings;
        settings.samples_per_pixel = 8;
        settings.aovs.variance = true;
        Control control;
        const View view{scene.camera, kSize, kSize};
        const ImageRgb path = raytrace::render(raytrace::prepare(scene, settings), view, settings, control).radiance;
        const ImageRgb last = shown_images.image(kRungCount);
        double largest = 0;
        for (std::size_t i = 0; i < path.size(); ++i)
            for (std::size_t c = 0; c < 3; ++c)
                largest =
                    std::max(largest, std::abs(static_cast<double>(path[i][c]) - static_cast<double>(last[i][c])) /
                                          (static_cast<double>(path[i][c]) + 1e-3));
        CHECK(largest < 2e-6);
        CHECK(shown_images.invalid_samples == 0);
        const LadderImages again = ladder_scene(scene, 8, 7);
        for (std::size_t half = 0; half < 2; ++half)
            for (std::size_t k = 0; k < kRungCount; ++k)
                CHECK(shown_images.halves[half][k].pixels() == again.halves[half][k].pixels());
    }

    TEST_CASE("rung 2 computes with the path tracer's surfaces: nothing changes, for the code is shared") {
        const Scene scene = load_scene(fs::path(DUET_SOURCE_DIR) / "models" / "everything.json");
        const LadderImages shown_images = ladder_scene(scene, 4);
        CHECK(shown_images.halves[0][0].pixels() == shown_images.halves[0][1].pixels());
        CHECK(shown_images.image(1).pixels() != shown_images.image(0).pixels());
        const Shares s = shares(shown_images);
        CHECK(std::abs(s.sum - 1) < 1e-12);
    }

    TEST_CASE("the command writes its files; report.json has the promised keys, --stats the same figures") {
        const ScratchFolder scratch;
        LadderOptions options = small_ladder(scratch / "deep" / "report");
        options.stats = (scratch / "stats.json").string();
        REQUIRE(ladder(options) == 0);
        const json report = json::parse(read_file(options.folder / "report.json"));
        CHECK(report == json::parse(read_file(options.stats)));
        CHECK(report["samples_per_pixel"]["raytrace"] == 4); // rounded up to two halves
        CHECK(std::abs(report["shares_sum"].get<double>() - 1) < 1e-12);
        double sum = 0;
        for (const json& share : report["shares"]) sum += share["share"].get<double>();
        CHECK(sum == doctest::Approx(1).epsilon(1e-12));
        REQUIRE(report["rungs"].size() == kRungCount);
        std::vector<std::string> shown_images = {"cause.png", "image-0.png"};
        for (std::size_t k = 0; k < kRungCount; ++k) {
            const json& rung = report["rungs"][k];
            CHECK(rung["code"]["raytrace"].contains("lines"));
            shown_images.push_back(message("image-", k + 1, ".png"));
            shown_images.push_back(message("change-", k + 1, ".png"));
            for (const json& q : rung["quantities"]) {
                CHECK(q.contains(q["name"] == "hits" ? "hits" : "metrics"));
                CHECK(q["seconds"]["raster"].get<double>() > 0);
                for (const char* const side : {"-raster.png", "-raytrace.png"})
                    shown_images.push_back(message(k + 1, '-', q["name"].get<std::string>(), side));
            }
        }
        // The Cornell box has no environment, metal or glass. The report of these rungs says so and has no images.
        for (const std::size_t k : {std::size_t{4}, std::size_t{5}}) {
            CHECK(report["rungs"][k]["quantities"].empty());
            CHECK(report["rungs"][k]["note"].get<std::string>().find("The scene has no") == 0);
        }
        CHECK(report["rungs"][3]["note"].get<std::string>().find("Soft shadows are estimated") != std::string::npos);
        for (const std::string& name : shown_images)
            CHECK_MESSAGE(read_image(options.folder / name).width() == 24, name);
        std::size_t files = 0;
        for (const fs::directory_entry& entry : fs::directory_iterator(options.folder))
            files += entry.is_regular_file() ? 1 : 0;
        CHECK(files == shown_images.size() + 2);
        const std::string page = read_file(options.folder / "index.html");
        CHECK(page.find("cornell.json") != std::string::npos);
        CHECK(page.find("http://") == std::string::npos);
        CHECK(page.find("https://") == std::string::npos);
    }

    TEST_CASE("the same figures for any number of threads; a folder that cannot be made is refused") {
        const ScratchFolder scratch;
        std::vector<json> reports;
        for (const int threads : {1, 7}) {
            LadderOptions options = small_ladder(scratch.path());
            options.settings.threads = threads;
            REQUIRE(ladder(options) == 0);
            reports.push_back(without_times(json::parse(read_file(scratch / "report.json"))));
        }
        CHECK(reports[0] == reports[1]);
        write_file(scratch / "file", "x");
        CHECK_THROWS_AS(ladder(small_ladder(scratch / "file")), Error);
        LadderOptions options = small_ladder(scratch.path());
        options.stats = (scratch / "missing" / "stats.json").string();
        CHECK_THROWS_AS(ladder(options), Error);
    }

    TEST_CASE("the table of code has each source of raster/ and raytrace/ once, and counts its lines") {
        std::map<std::string, int> listed;
        for (const CodeFile& file : code_files()) {
            CAPTURE(file.path);
            CHECK(file.rung >= 0);
            CHECK(file.rung <= static_cast<int>(kRungCount));
            CHECK((file.side == "raster" || file.side == "raytrace" || file.side == "both"));
            ++listed[std::string(file.path)];
            int lines = 0;
            std::istringstream text(read_file(fs::path(DUET_SOURCE_DIR) / file.path));
            for (std::string line; std::getline(text, line);) {
                const std::size_t begin = line.find_first_not_of(" \t");
                lines += begin != std::string::npos && line.compare(begin, 2, "//") != 0;
            }
            CHECK(file.lines == lines);
        }
        for (const char* const room : {"raster", "raytrace"})
            for (const fs::directory_entry& entry :
                 fs::recursive_directory_iterator(fs::path(DUET_SOURCE_DIR) / room)) {
                const std::string path = fs::relative(entry.path(), DUET_SOURCE_DIR).generic_string();
                const std::string ending = entry.path().extension().string();
                if ((ending != ".h" && ending != ".cpp") || path.ends_with("_main.cpp") ||
                    path.find("/lessons/") != std::string::npos)
                    continue;
                CHECK_MESSAGE(listed[path] == 1, path, ": compare/ladder/code.txt leads to it ", listed[path],
                              " times");
            }
    }
}
