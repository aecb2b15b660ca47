// The library's clipping and that of lesson raster-05 give the same corners.
#include "raster/geometry/clip.h"
#include "raster/lessons/05-clipping/clip.h"

#include <doctest/doctest.h>

#include <cstring>
#include <random>

using namespace duet;

TEST_SUITE("lesson") {

    TEST_CASE("raster-05: the library and the lesson clip a triangle to the same corners") {
        constexpr float kNear = 0.25f, kHalf = 32; // of an image of 64 × 64 pixels
        std::mt19937 random(5);
        const auto uniform = [&](float low, float high) { return std::uniform_real_distribution(low, high)(random); };
        std::array<int, 3> cases{};
        for (int i = 0; i < 20000; ++i) {
            lesson::Triangle triangle;
            std::array<raster::PixelVertex, 3> pixels;
            for (std::size_t k = 0; k < 3; ++k) {
                // w - near is exact on this grid; the far plane is at infinity. Now and then a corner is on the plane.
                const float w = i % 50 == 0 && k == 0 ? kNear : std::round(uniform(-4, 6) * 4096) / 4096;
                const float x = uniform(-8, 8), y = uniform(-8, 8);
                triangle[k] = {{x, y, w - kNear, w}, {}, {}, {static_cast<float>(k == 1), static_cast<float>(k == 2)}};
                const auto xw = static_cast<double>((x + w) * kHalf), yw = static_cast<double>((w - y) * kHalf);
                pixels[k] = {xw, yw, static_cast<double>(w), static_cast<double>(w)};
            }
            const auto parts = lesson::clip_near(triangle);
            const raster::ClippedPolygon polygon =
                raster::clip(pixels[0], pixels[1], pixels[2], {.width = 64, .height = 64, .near = kNear});
            CAPTURE(i);
            REQUIRE(parts.size() == static_cast<std::size_t>(std::max(polygon.count - 2, 0)));
            if (i % 50) ++cases[parts.size()];
            for (std::size_t part = 0; part < parts.size(); ++part)
                for (std::size_t k = 0; k < 3; ++k) { // part 0 has the outline's corners 0, 1, 2, part 1 has 0, 2, 3
                    const Vec4 found = parts[part][k].clip;
                    const raster::PixelVertex& expected = polygon.vertices[k == 0 ? 0 : part + k];
                    // Coordinates are below 500: off by at most a few roundings of 2^-24 of that.
                    REQUIRE(std::abs(static_cast<double>((found.x + found.w) * kHalf) - expected.xw) < 2e-4);
                    REQUIRE(std::abs(static_cast<double>((found.w - found.y) * kHalf) - expected.yw) < 2e-4);
                    REQUIRE(std::abs(static_cast<double>(found.w) - expected.w) < 2e-6);
                }
        }
        for (const int count : cases) CHECK(count > 1000); // none, one and two triangles all occurred
    }

    TEST_CASE("raster-05: neighbors get the same crossing, bit for bit, and the value of the page") {
        const auto corner = [](float x, float y, float z, float w) { return lesson::Vertex{{x, y, z, w}, {}, {}, {}}; };
        const lesson::Vertex page = lesson::crossing(corner(0, 0, 3, 4), corner(4, 8, -1, 0));
        CHECK(page.clip == Vec4(3, 6, 0, 1));
        std::mt19937 random(55);
        const auto uniform = [&](float low, float high) { return std::uniform_real_distribution(low, high)(random); };
        const auto any = [&](float low, float high) {
            const float x = uniform(-9, 9), y = uniform(-9, 9), z = uniform(low, high);
            return corner(x, y, z, z + 0.1f);
        };
        for (int i = 0; i < 5000; ++i) {
            // The edge from a to b, a in front and b behind, in a triangle on either side of it.
            const lesson::Vertex a = any(0, 5), b = any(-5, -0.01f), left = any(-5, -0.01f), right = any(-5, -0.01f);
            const auto one = lesson::clip_near({a, b, left}), other = lesson::clip_near({b, a, right});
            REQUIRE(one.size() == 1);
            REQUIRE(other.size() == 1);
            // {a, crossing of ab, crossing of left a}, and {crossing of ba, a, crossing of a right}
            REQUIRE(std::memcmp(&one[0][1].clip, &other[0][0].clip, sizeof(Vec4)) == 0);
        }
    }
}
