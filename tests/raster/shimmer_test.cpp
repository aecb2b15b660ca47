// These tests measure how much more than necessary silhouette pixels change while the camera moves by fractions of a
// pixel.
#include "tests/raster/scenes.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::test;

namespace {

constexpr int kFrames = 6, kFiner = 4;

/// Returns round and sharp objects on a floor, between a light and a sky.
Scene still_life(const Material& floor) {
    Scene scene;
    add(scene, QuadList{{{Vec3(-3, 0, 3), Vec3(6, 0, 0), Vec3(0, 0, -6)}}}, Mat4(), floor);
    add(scene, Sphere{Vec3(-0.7f, 0.5f, 0), 0.5f}, Mat4(), Diffuse{{Rgb(0.8f, 0.3f, 0.2f)}});
    add(scene, torus(48, 24, 0.45, 0.15), translation(Vec3(0.6f, 0.3f, 0.3f)) * Mat4(rotation(Vec3(1, 0, 0), 0.6f)));
    add(scene, box_quads(Vec3(0.1f, 0, -1), Vec3(0.7f, 0.9f, -0.5f)), Mat4(), Diffuse{{Rgb(0.2f, 0.4f, 0.8f)}});
    add(scene, QuadList{{{Vec3(-0.5f, 3, -0.5f), Vec3(1, 0, 0), Vec3(0, 0, 1)}}}, Mat4(), Emissive{Rgb(9.0f)});
    scene.environment = SkyEnvironment{};
    finish_scene(scene);
    return scene;
}

/// Returns a frame of the camera path, which moves an eighth of a center pixel per frame to the right and slightly
/// down.
View frame(int i, int finer = 1) {
    View view{look({0.5, 1.6, 3.6}, {0, 0.4, 0}, 34), 128 * finer, 96 * finer};
    const double pixel = 2 * std::tan(17 * kPiDouble / 180) * length(view.camera.look_at - view.camera.eye) / 96;
    const Vec3d moved = Vec3d(0.99, 0, -0.137) * (pixel * i / 8) + Vec3d(0, -1, 0) * (pixel * i / 24);
    view.camera.eye += moved, view.camera.look_at += moved;
    return view;
}

/// Averages an image that is finer by kFiner down to the test's resolution.
ImageRgb reduced(const ImageRgb& fine) {
    ImageRgb result(fine.width() / kFiner, fine.height() / kFiner);
    for (int y = 0; y < fine.height(); ++y)
        for (int x = 0; x < fine.width(); ++x) result(x / kFiner, y / kFiner) += fine(x, y) / float{kFiner * kFiner};
    return result;
}

/// Returns the pixels that are next to a different object in any frame.
Image<std::uint8_t> silhouettes(const Scene& scene) {
    Image<std::uint8_t> result(128, 96, 0);
    for (int i = 0; i < kFrames; ++i) {
        const Image<Hit> hits = render(scene, frame(i), hits_only()).hit;
        for (int y = 1; y + 1 < hits.height(); ++y)
            for (int x = 1; x + 1 < hits.width(); ++x)
                for (const auto& [dx, dy] : {std::pair(1, 0), std::pair(0, 1), std::pair(-1, 0), std::pair(0, -1)})
                    if (hits(x + dx, y + dy).object != hits(x, y).object) result(x, y) = 1;
    }
    return result;
}

struct Shimmer {
    double change = 0, due = 0; ///< mean change of a pixel from frame to frame: measured, and in the finer images
    double worst = 0;           ///< largest excess of a pixel's change
};
Shimmer shimmer(const Scene& scene, const raster::RasterSettings& settings) {
    raster::RasterSettings fine = settings;
    fine.samples_per_pixel = 4;
    const Image<std::uint8_t> counts = silhouettes(scene);
    const raster::RasterScene prepared = raster::prepare(scene, settings), prepared_fine = raster::prepare(scene, fine);
    Shimmer result;
    int pixels = 0;
    ImageRgb last, last_due;
    for (int i = 0; i < kFrames; ++i) {
        Control control;
        const ImageRgb found = raster::render(prepared, frame(i), settings, control).radiance;
        const ImageRgb due = reduced(raster::render(prepared_fine, frame(i, kFiner), fine, control).radiance);
        for (std::size_t k = 0; k < found.size() && i > 0; ++k) {
            if (counts[k] == 0) continue;
            const double change = std::abs(static_cast<double>(found[k].g - last[k].g));
            const double owed = std::abs(static_cast<double>(due[k].g - last_due[k].g));
            result.change += change, result.due += owed, result.worst = std::max(result.worst, change - owed);
            ++pixels;
        }
        last = found, last_due = due;
    }
    REQUIRE(pixels > 2000);
    result.change /= pixels, result.due /= pixels;
    return result;
}

raster::RasterSettings only(bool direct, bool environment, bool reflection) {
    raster::RasterSettings settings;
    settings.components = {.emission = false, .direct = direct, .environment = environment, .reflection = reflection};
    settings.samples_per_pixel = 16;
    return settings;
}

} // namespace

TEST_SUITE("image") {

    TEST_CASE("silhouettes of each effect change by no more than they should while the camera moves") {
        const Scene matt = still_life(Diffuse{{Rgb(0.7f)}}), mirror = still_life(Metal{{Rgb(0.9f)}, 0});
        struct Case {
            std::string name;
            const Scene& scene;
            raster::RasterSettings settings;
            double worst; ///< bound for a pixel that changes by light of radiance 1
        };
        const std::array<Case, 3> cases{{{"soft shadows", matt, only(true, false, false), 0.1},
                                         {"ambient occlusion", matt, only(false, true, false), 0.15},
                                         {"reflections", mirror, only(false, false, true), 0.3}}};
        for (const Case& c : cases) {
            const Shimmer found = shimmer(c.scene, c.settings);
            CAPTURE(c.name);
            CAPTURE(found.change);
            CAPTURE(found.due);
            CAPTURE(found.worst);
            CHECK(found.change < 1.2 * found.due + 1e-3);
            CHECK(found.worst < c.worst);
        }
        raster::RasterSettings hard = only(true, true, false); // without smoothing: the measure must detect the shimmer
        hard.samples_per_pixel = 1;
        const Shimmer found = shimmer(matt, hard);
        CHECK(found.worst > 0.55); // measured: 0.595
    }
}
