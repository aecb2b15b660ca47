// Lesson raster-07: texels and weights in perspective are the library's.
#include "common/texture/texture.h"
#include "raster/geometry/planes.h"
#include "raster/lessons/07-textures/pipeline.h"
#include "raster/lessons/07-textures/texture.h"

#include <doctest/doctest.h>

#include <random>

using namespace duet;

TEST_SUITE("lesson") {

    TEST_CASE("raster-07: nearest texels are the library's, bilinear ones to the last digits") {
        std::mt19937 random(7);
        const auto uniform = [&](float low, float high) {
            return std::uniform_real_distribution<float>(low, high)(random);
        };
        TextureSet set;
        set.images.push_back(ImageRgb(13, 8));
        for (Rgb& pixel : set.images.edit(0).pixels()) pixel = {uniform(0, 1), uniform(0, 1), uniform(0, 1)};
        const auto library = [&](Vec2 uv, TextureFilter filter) {
            SurfacePoint point{};
            point.uv = uv;
            return evaluate_texture(set, ImageTexture{.image = 0, .scale = {1, 1}, .filter = filter}, point);
        };
        int between_texels = 0;
        for (int i = 0; i < 20'000; ++i) {
            const float u = uniform(-3, 3);
            const Vec2 uv{u, uniform(-3, 3)};
            const Rgb naive = lesson::bilinear(set.images[0], uv), fast = library(uv, TextureFilter::kBilinear);
            // Coordinates up to 3 are rounded by 2^-23 at most, or 13 times that in texels.
            REQUIRE(max_component(naive - fast) < 1e-5f);
            REQUIRE(max_component(fast - naive) < 1e-5f);
            const auto from_edge = [](float x) { return std::abs(x - std::round(x)); };
            if (from_edge(uv.x * 13) < 1e-4f || from_edge(uv.y * 8) < 1e-4f) continue; // rounding decides
            REQUIRE(lesson::nearest(set.images[0], uv) == library(uv, TextureFilter::kNearest));
            between_texels += !(naive == lesson::nearest(set.images[0], uv));
        }
        CHECK(between_texels > 19'000);
    }

    TEST_CASE("raster-07: weights in perspective are those of the library's planes") {
        std::mt19937 random(77);
        const auto uniform = [&](float low, float high) {
            return std::uniform_real_distribution<float>(low, high)(random);
        };
        int bent = 0;
        for (int i = 0; i < 5000; ++i) {
            lesson::Triangle triangle;
            std::array<double, 3> x{}, y{}, w{};
            std::array<Vec2, 3> pixel;
            for (std::size_t k = 0; k < 3; ++k) {
                const float px = uniform(0, 100), py = uniform(0, 100), distance = uniform(0.3f, 6);
                pixel[k] = {px, py};
                triangle[k].clip = {0, 0, 0, distance};
                w[k] = static_cast<double>(distance);
                x[k] = static_cast<double>(px) * w[k], y[k] = static_cast<double>(py) * w[k];
            }
            const Vec2 ab = pixel[1] - pixel[0], ac = pixel[2] - pixel[0];
            if (std::abs(ab.x * ac.y - ab.y * ac.x) < 100) continue; // narrow: rounding decides
            const float b = uniform(0, 1), c = (1 - b) * uniform(0, 1);
            const Vec2 p = pixel[0] + ab * b + ac * c;
            const auto planes = raster::triangle_planes<double>(x, y, w, {0, 0, 0});
            const auto at = [&](const std::array<double, 3>& plane) {
                return plane[0] * static_cast<double>(p.x) + plane[1] * static_cast<double>(p.y) + plane[2];
            };
            const Vec3 seen{1 - b - c, b, c}, naive = lesson::perspective_weights(triangle, seen);
            REQUIRE(std::abs(static_cast<double>(naive.y) - at(planes.e1) / at(planes.sum)) < 1e-4);
            REQUIRE(std::abs(static_cast<double>(naive.z) - at(planes.e2) / at(planes.sum)) < 1e-4);
            bent += length(naive - seen) > 0.05f;
        }
        CHECK(bent > 2000);
    }
}
