// The walk from line to line of lesson raster-00 ends at the wall that the library's path tracer finds.
#include "common/image/image_file.h"
#include "common/system/parameters.h"
#include "raytrace/acceleration/accelerator.h"
#include "tests/raytrace/scene_builder.h"

#include <doctest/doctest.h>

#include <random>

// The program as it is; its headers are included above. Its main function, here an ordinary one, is never called.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wreturn-type"
namespace maze {
#include "raster/lessons/00-maze/lesson.cpp"
} // namespace maze
#pragma GCC diagnostic pop

using namespace duet;

TEST_SUITE("lesson") {

    TEST_CASE("raster-00: the walk that the page makes by hand") {
        const Vec2 eye{7.5f, 11.07f}, ray{1, -0.75f};
        const maze::Hit hit = maze::cast(eye, ray);
        const std::array<double, 5> expected{0.07 / 0.75, 0.5, 1.07 / 0.75, 1.5, 2.5};
        REQUIRE(hit.checked.size() == expected.size());
        for (std::size_t i = 0; i < expected.size(); ++i)
            CHECK(static_cast<double>(hit.checked[i].x - eye.x) == doctest::Approx(expected[i]).epsilon(1e-5));
        CHECK(hit.t == 2.5f);
        CHECK(hit.square == 'R');
        CHECK(hit.on_side);
    }

    TEST_CASE("raster-00: the walk and the library meet the same wall at the same distance") {
        raytrace::SceneBuilder builder;
        const auto material = builder.material(Diffuse{});
        std::vector<std::pair<int, int>> walls, free;
        for (int row = 0; row < 16; ++row)
            for (int column = 0; column < 17; ++column) {
                (maze::square_at(column, row) == '.' ? free : walls).push_back({column, row});
                if (maze::square_at(column, row) == '.') continue;
                const auto x = static_cast<float>(column), z = static_cast<float>(row); // y is up, from 0 to 1
                const Vec3 up{0, 1, 0}, right{1, 0, 0}, down{0, 0, 1};                  // directions on the paper
                builder.add(QuadList{{{{x, 0, z}, right, up},
                                      {{x, 0, z + 1}, right, up},
                                      {{x, 0, z}, down, up},
                                      {{x + 1, 0, z}, down, up}}},
                            material);
            }
        const Scene scene = builder.finish();
        const raytrace::Accelerator library(scene, 1);
        std::mt19937 random(7);
        const auto uniform = [&](float low, float high) { return std::uniform_real_distribution(low, high)(random); };
        int others = 0;
        for (int i = 0; i < 20'000; ++i) {
            const auto [column, row] = free[random() % free.size()];
            const float x = static_cast<float>(column) + uniform(0.01f, 0.99f);
            const Vec2 eye{x, static_cast<float>(row) + uniform(0.01f, 0.99f)};
            const float angle = uniform(0, 2 * kPi);
            Vec2 ray = Vec2{std::cos(angle), std::sin(angle)} * uniform(0.5f, 2);
            if (i % 8 == 0) ray = i % 16 ? Vec2{0, ray.y} : Vec2{ray.x, 0}; // along an axis
            const maze::Hit hit = maze::cast(eye, ray);
            const duet::Hit found = library.closest(Ray{{eye.x, 0.5f, eye.y}, {ray.x, 0, ray.y}});
            CAPTURE(i);
            REQUIRE(found.valid());
            const auto [wall_column, wall_row] = walls[found.object];
            const Vec2 in = hit.checked.back() - Vec2{static_cast<float>(wall_column), static_cast<float>(wall_row)};
            // Where two walls touch, and at corners, rounding decides which one is met.
            const bool same = hit.square == maze::square_at(wall_column, wall_row) &&
                              std::abs(hit.t - found.t) < 1e-4f * (1 + hit.t) && in.x > -1e-3f && in.x < 1.001f &&
                              in.y > -1e-3f && in.y < 1.001f;
            others += !same;
        }
        CHECK(others <= 5);
    }
}
