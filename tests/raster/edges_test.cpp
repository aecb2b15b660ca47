// These tests check where ink lines appear and where they do not.
#include "raster/overlay/edges.h"
#include "tests/raster/varied_scene.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::test;

namespace {

Rendering inked(const Scene& scene, const View& view, raster::RasterSettings settings = {}) {
    settings.shading = raster::Shading::kEdges;
    settings.aovs.hit = true;
    return render(scene, view, settings);
}

/// Returns whether the pixel or one of its eight neighbors has ink.
bool ink_near(const ImageRgb& image, int x, int y) {
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
            if (x + dx >= 0 && y + dy >= 0 && x + dx < image.width() && y + dy < image.height() &&
                image(x + dx, y + dy).r < 0.5f)
                return true;
    return false;
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("no ink on a plane, however low it is seen; a line where it ends") {
        Scene scene;
        add(scene, QuadList{{Quad{Vec3(-50, 0, 50), Vec3(100, 0, 0), Vec3(0, 0, -100)}}});
        finish_scene(scene);
        const View view{look({0, 0.5, 0}, {0, 0.3, -8}, 50), 200, 150};
        const Rendering image = inked(scene, view);
        int on_plane = 0, spots = 0, border = 0, inked_border = 0;
        for (int y = 1; y + 1 < view.height; ++y)
            for (int x = 0; x < view.width; ++x) {
                if (!image.hit(x, y).valid()) continue;
                const bool at_end = !image.hit(x, y - 1).valid();
                (at_end ? border : on_plane) += 1;
                (at_end ? inked_border : spots) += image.radiance(x, y).r < 1;
            }
        CHECK(on_plane > 10'000);
        CHECK(spots == 0);
        CHECK(border >= view.width);
        CHECK(inked_border == border);
    }

    TEST_CASE("ink at steps of depth within one object, at creases, and between objects") {
        Scene scene;
        // Two squares of one object face the eye, one in front of the other: a depth step without a crease.
        add(scene, QuadList{{Quad{Vec3(-2, -2, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)},
                             Quad{Vec3(-1, -1, 0.5f), Vec3(1, 0, 0), Vec3(0, 1, 0)}}});
        // The roof is a crease without a depth step. Beside it is a coplanar square of another object.
        add(scene, QuadList{{Quad{Vec3(0.3f, -1, 0.2f), Vec3(0.5f, 0, 0.4f), Vec3(0, 2, 0)},
                             Quad{Vec3(0.8f, -1, 0.6f), Vec3(0.5f, 0, -0.4f), Vec3(0, 2, 0)}}});
        add(scene, QuadList{{Quad{Vec3(-1, 0.5f, 0.5f), Vec3(0.5f, 0, 0), Vec3(0, 0.5f, 0)}}});
        add(scene, QuadList{{Quad{Vec3(-0.5f, 0.5f, 0.5f), Vec3(0.5f, 0, 0), Vec3(0, 0.5f, 0)}}});
        finish_scene(scene);
        const View view{look({0, 0, 6}, {0, 0, 0}, 30), 240, 240};
        const Rendering image = inked(scene, view);
        const auto near_point = [&](Vec3d p) {
            const Vec3d at = CameraModel(view).pinhole().project(p);
            return ink_near(image.radiance, static_cast<int>(at.x), static_cast<int>(at.y));
        };
        for (const double along : {-0.7, -0.4, -0.2}) {
            CHECK(near_point({-1, along, 0.5}));                // the step's left side
            CHECK(near_point({along, -1, 0.5}));                // the step's lower side
            CHECK(near_point({0.8, along, 0.6}));               // the crease
            CHECK(!near_point({-0.5, along, 0.5}));             // inside the square
            CHECK(!near_point({0.55, along, 0.4}));             // inside a face of the roof
            CHECK(near_point({-0.5, -along * 0.3 + 0.6, 0.5})); // where two objects meet in one plane
        }
    }

    TEST_CASE("what has holes is inked where it is whole, hides the lines behind, and shows them through its holes and "
              "a thin sheet") {
        const auto square = [](float half, float z) {
            return QuadList{{Quad{{-half, -half, z}, {2 * half, 0, 0}, {0, 2 * half, 0}}}};
        };
        Scene scene;
        ImageRgb halves(2, 1);
        halves(0, 0) = Rgb(1.0f), halves(1, 0) = Rgb(0.0f); // the left texel is opaque
        scene.textures = {{ImageTexture{0, {1, 1}, TextureFilter::kNearest}}, {halves}};
        add(scene, square(1, 0.0f));
        add(scene, square(0.5f, -1));
        const View view{look({0, 0, 6}, {0, 0, 0}, 30), 240, 240};
        const auto inked_at = [&](ScalarSlot opacity, double x, double y, double z) {
            scene.maps.resize(scene.materials.size());
            scene.maps[0].opacity = opacity;
            finish_scene(scene);
            const Vec3d at = CameraModel(view).pinhole().project({x, y, z});
            return ink_near(inked(scene, view).radiance, static_cast<int>(at.x), static_cast<int>(at.y));
        };
        const ScalarSlot half{1, 0};
        CHECK(inked_at(half, -1, 0.3, 0));
        CHECK(inked_at(half, 0, 0.8, 0));  // the boundary of the alpha mask
        CHECK(!inked_at(half, 1, 0.3, 0)); // transparent here
        CHECK(inked_at(half, 0.5, 0.3, -1));
        CHECK(!inked_at(half, -0.5, 0.3, -1));
        CHECK(inked_at(0.4f, -0.5, 0.3, -1));
        CHECK(!inked_at(0.4f, -1, 0.3, 0));
        CHECK(!inked_at(0.6f, -0.5, 0.3, -1));
        CHECK(inked_at(0.6f, -1, 0.3, 0));
    }

    TEST_CASE("every silhouette has its line; the overlay keeps the image elsewhere; threads don't matter") {
        const Scene scene = varied_scene(120);
        const View view = perspective();
        const Rendering image = inked(scene, view);
        int silhouette = 0, missing = 0;
        for (int y = 0; y < view.height; ++y)
            for (int x = 1; x < view.width; ++x)
                if (image.hit(x, y).object != image.hit(x - 1, y).object) {
                    ++silhouette;
                    missing += image.radiance(x, y).r > 0 || image.radiance(x - 1, y).r > 0;
                }
        CHECK(silhouette > 400);
        CHECK(missing == 0);
        raster::RasterSettings settings;
        settings.shading = raster::Shading::kPhong;
        const Rendering plain = render(scene, view, settings);
        settings.edges = true;
        settings.threads = 1;
        const Rendering over = render(scene, view, settings);
        settings.threads = 7;
        CHECK(render(scene, view, settings).radiance.pixels() == over.radiance.pixels());
        for (int y = 0; y < view.height; ++y)
            for (int x = 0; x < view.width; ++x) {
                const float paper = image.radiance(x, y).r;
                REQUIRE(over.radiance(x, y) == plain.radiance(x, y) * paper);
            }
        settings.multisamples = 4;
        CHECK_THROWS_AS(render(scene, view, settings), Error);
    }
}
