// The library's visibility and the z-buffer of lesson raster-03 see the same triangles.
#include "compare/stress/raster_stages.h"
#include "raster/lessons/03-z-buffer/framebuffer.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

using namespace duet;

TEST_SUITE("lesson") {

    TEST_CASE("raster-03: a pixel keeps the nearest depth, and of equal ones the first") {
        lesson::Framebuffer target(1, 1, Rgb(0));
        target.write(0, 0, std::nanf(""), Rgb(9));
        CHECK(target.color(0, 0) == Rgb(0));
        target.write(0, 0, 0.5f, Rgb(1));
        target.write(0, 0, 0.5f, Rgb(2)); // as near: the first one stays
        CHECK(target.color(0, 0) == Rgb(1));
        target.write(0, 0, 0.75f, Rgb(3));
        CHECK(target.color(0, 0) == Rgb(1));
        target.write(0, 0, 0.25f, Rgb(4));
        CHECK(target.color(0, 0) == Rgb(4));
        CHECK(target.depth(0, 0) == 0.25f);
    }

    // An orthographic camera whose pixels are a meter wide. Corners are on the grid of 1/256 pixel, so that both snap
    // them to where they are. The library compares reversed depths, near / depth, and the lesson depths: where the two
    // nearest triangles are closer than the rounding of either, they may disagree.
    TEST_CASE("raster-03: the library sees the triangle that the lesson's z-buffer keeps") {
        constexpr int kSize = 48, kTriangles = 9;
        View view;
        view.width = view.height = kSize;
        view.camera.projection = Camera::Projection::kOrthographic;
        view.camera.eye = {0, 0, 0}, view.camera.look_at = {0, 0, -1};
        view.camera.height = kSize, view.camera.near = 1;
        const compare::Window window{{0, 0, kSize, kSize}, {}};
        std::mt19937 random(3);
        const auto integer = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
        int seen = 0, close = 0;
        for (int trial = 0; trial < 60; ++trial) {
            Mesh mesh;
            std::vector<Vec3> pixels; // x and y in pixels, z the depth in meters
            for (int i = 0; i < 3 * kTriangles; ++i) {
                const auto corner = [&] { return static_cast<float>(integer(-8 * 256, (kSize + 8) * 256)) / 256; };
                const float x = corner(), y = corner(), depth = static_cast<float>(integer(2 * 256, 9 * 256)) / 256;
                pixels.push_back({x, y, depth});
                mesh.positions.push_back({x - kSize / 2, kSize / 2 - y, -depth});
                const auto k = static_cast<std::uint32_t>(i);
                if (i % 3 == 2) mesh.triangles.push_back({k - 2, k - 1, k});
            }
            const compare::SetupTriangles setup = compare::set_up_triangles(mesh, view, window.offset);
            REQUIRE(setup.source_triangles.size() == kTriangles);
            const auto tile = compare::draw(setup, view, window);
            lesson::Framebuffer lesson(kSize, kSize, Rgb(-1)); // the color is the number of the triangle
            ImageFloat second(kSize, kSize, kInfinity);        // the depth of the nearest but one
            for (std::size_t i = 0; i < kTriangles; ++i) {
                const Vec3 a = pixels[3 * i], b = pixels[3 * i + 1], c = pixels[3 * i + 2];
                lesson::for_each_pixel({a.x, a.y}, {b.x, b.y}, {c.x, c.y}, kSize, kSize, [&](int x, int y, Vec3 w) {
                    const float z = dot(w, Vec3{a.z, b.z, c.z});
                    second(x, y) = std::min(second(x, y), std::max(z, lesson.depth(x, y)));
                    lesson.write(x, y, z, Rgb(static_cast<float>(i)));
                });
            }
            for (int y = 0; y < kSize; ++y)
                for (int x = 0; x < kSize; ++x) {
                    CAPTURE(trial);
                    CAPTURE(x);
                    CAPTURE(y);
                    const std::uint32_t id = tile->id(x, y);
                    const bool covered = lesson.depth(x, y) < kInfinity;
                    REQUIRE((id != raster::kNoTriangle) == covered);
                    if (!covered) continue;
                    ++seen;
                    if (second(x, y) - lesson.depth(x, y) < 1e-5f) {
                        ++close;
                        continue;
                    }
                    REQUIRE(id == static_cast<std::uint32_t>(lesson.color(x, y).r));
                    REQUIRE(std::abs(1 / tile->reversed_depth(x, y) - lesson.depth(x, y)) < 1e-5f);
                }
        }
        CHECK(seen > 80'000);
        CHECK(close < 20);
    }
}
