// The library's coverage and that of lesson raster-02 are one.
#include "compare/stress/raster_stages.h"
#include "raster/lessons/02-triangles/triangle.h"

#include <doctest/doctest.h>

#include <random>

using namespace duet;

TEST_SUITE("lesson") {

    TEST_CASE("raster-02: the library covers the pixels that the lesson covers") {
        constexpr int kSize = 48;
        std::mt19937 random(2);
        const auto integer = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
        for (int i = 0; i < 1500; ++i) {
            // From triangles smaller than a pixel to some far larger than the picture. Every fourth has its corners on
            // centers of pixels, so that its edges pass through others.
            const int reach = std::array{200, 2000, 12288, 250'000}[static_cast<std::size_t>(i) % 4];
            const int x = integer(0, 12288), y = integer(0, 12288);
            compare::GridTriangle grid;
            std::array<Vec2, 3> pixels;
            for (std::size_t k = 0; k < 3; ++k) {
                raster::FixedPoint p{x + integer(-reach, reach), y + integer(-reach, reach)};
                if (i % 16 < 4) p = {p.x / 256 * 256 + 128, p.y / 256 * 256 + 128};
                grid[k] = p;
                pixels[k] = {static_cast<float>(p.x) / 256, static_cast<float>(p.y) / 256}; // exact
            }
            Image<int> lesson(kSize, kSize), library(kSize, kSize);
            lesson::for_each_pixel(pixels[0], pixels[1], pixels[2], kSize, kSize, [&](int px, int py, Vec3 w) {
                ++lesson(px, py);
                REQUIRE(std::abs(w.x + w.y + w.z - 1) < 1e-5f);
            });
            compare::CoverageProbe probe({{0, 0, kSize, kSize}, {}});
            probe.draw(grid);
            for (int py = 0; py < kSize; ++py)
                for (int px = 0; px < kSize; ++px) library(px, py) = probe.covers(px, py);
            CAPTURE(i);
            REQUIRE(lesson.pixels() == library.pixels());
        }
    }
}
