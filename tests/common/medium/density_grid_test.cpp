#include "common/medium/cloud.h"
#include "common/medium/density_grid.h"
#include "common/medium/medium.h"
#include "common/sampling/warp.h"
#include "tests/support/random.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace duet;
using duet::test::Random;

namespace {

DensityGrid random_grid(std::array<int, 3> size, float share_of_empty, std::uint64_t seed) {
    Random random(seed);
    std::vector<float> densities(static_cast<std::size_t>(size[0] * size[1] * size[2]));
    for (float& density : densities) density = random() < share_of_empty ? 0 : 3 * random();
    return {size, std::move(densities)};
}

/// Interpolates in double precision, without cells: the weight of a point is a product of hats.
double naive_density(const DensityGrid& grid, const Box3& box, Vec3d p) {
    double sum = 0;
    std::size_t i = 0;
    const auto hat = [&](std::size_t axis, int index) {
        const double low = static_cast<double>(box.low[axis]), high = static_cast<double>(box.high[axis]);
        const double at = (p[axis] - low) / (high - low) * (grid.size()[axis] - 1);
        return std::max(0.0, 1 - std::abs(at - index));
    };
    for (int z = 0; z < grid.size()[2]; ++z)
        for (int y = 0; y < grid.size()[1]; ++y)
            for (int x = 0; x < grid.size()[0]; ++x, ++i)
                if (grid.densities()[i] > 0)
                    sum += hat(0, x) * hat(1, y) * hat(2, z) * static_cast<double>(grid.densities()[i]);
    return sum;
}

/// Returns a ray to a random point of the box, at times parallel to axes, from within or from afar.
Ray random_ray(Random& random, const Box3& box, int kind) {
    const Vec3 size = box.diagonal();
    const auto point = [&] { return box.low + Vec3(random(), random(), random()) * size; };
    Vec3 direction = uniform_sphere(random.pair());
    if (kind % 3 == 1) direction = {0, 0, -1};
    if (kind % 3 == 2) direction = normalize(Vec3(direction.x, 0, direction.z));
    return Ray{point() - direction * (kind % 2 == 0 ? 0 : 3 * size.x), direction};
}

// Asks a ray that remembers what it has passed for near and far points in turn.
void check_remembered_columns(const Medium& medium, const Ray& ray, Interval inside, float whole) {
    DensityOnRay on_ray(*medium.density, medium.box, ray, inside);
    const float rounding = medium.density->largest() * inside.end * 2e-7f; // of t
    for (const float part : {0.01f, 0.7f, 0.3f, 0.95f, 1.01f}) {
        CAPTURE(part);
        const double wanted = static_cast<double>(part * whole);
        const DensityGrid::Reached reached = on_ray.follow(wanted);
        const PassedColumn expected = follow(medium, ray, inside, part * whole);
        REQUIRE((reached.t < kInfinity) == (expected.t < kInfinity));
        CHECK(static_cast<float>(reached.column) == doctest::Approx(expected.column).epsilon(1e-5));
        CHECK(on_ray.passed_by(wanted) >= reached.t);
        if (reached.t == kInfinity) continue;
        for (const float t : {reached.t, expected.t})
            CHECK(std::abs(static_cast<float>(on_ray.column(t)) - part * whole) <= 1e-5f * whole + rounding);
    }
    CHECK(static_cast<float>(on_ray.column(inside.begin)) == 0);
    CHECK(static_cast<float>(on_ray.column(inside.end)) == doctest::Approx(whole).epsilon(1e-5));
}

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("The density of a grid is trilinear") {
        Random random(1);
        const DensityGrid grid = random_grid({4, 11, 2}, 0.3f, 2);
        for (const float scale : {1e-6f, 1.0f, 1e6f}) {
            const Box3 box{Vec3(-1, 2, 0.5f) * scale, Vec3(1, 3, 4) * scale};
            for (int i = 0; i < 300; ++i) {
                const Vec3 p = box.low + Vec3(random(), random(), random()) * box.diagonal();
                CHECK(static_cast<double>(grid.density(box, p)) ==
                      doctest::Approx(naive_density(grid, box, Vec3d(p))).epsilon(1e-4));
            }
            CHECK(grid.density(box, box.low) == grid.densities().front());
            CHECK(grid.density(box, box.high) == grid.densities().back());
        }
    }

    TEST_CASE("The column of a ray is the integral of the density") {
        Random random(3);
        const std::array<int, 3> sizes[] = {{2, 2, 2}, {5, 9, 10}, {20, 18, 3}};
        for (const auto& size : sizes)
            for (const float empty : {0.0f, 0.5f, 0.995f})
                for (const float scale : {1e-6f, 1.0f, 1e6f}) {
                    CAPTURE(size[0]);
                    CAPTURE(empty);
                    CAPTURE(scale);
                    Medium medium;
                    medium.box = {Vec3(-1, -2, -1) * scale, Vec3(1, 0.5f, 2) * scale};
                    const DensityGrid grid = random_grid(size, empty, 4);
                    medium.density = std::make_shared<const DensityGrid>(grid);
                    for (int i = 0; i < 12; ++i) {
                        const Ray ray = random_ray(random, medium.box, i);
                        const Interval inside = overlap(medium.box, ray, kInfinity);
                        REQUIRE(!inside.empty());
                        const double begin = static_cast<double>(inside.begin),
                                     length = static_cast<double>(inside.end) - begin;
                        double truth = 0;
                        constexpr int kSteps = 400;
                        for (int k = 0; k < kSteps; ++k)
                            truth += naive_density(grid, medium.box,
                                                   Vec3d(ray.origin) +
                                                       Vec3d(ray.direction) * (begin + length * (k + 0.5) / kSteps)) *
                                     length / kSteps;
                        const float found = column_of(medium, ray.origin, ray.direction, inside);
                        CHECK(static_cast<double>(found) == doctest::Approx(truth).epsilon(5e-3));
                        if (!(found > 0)) continue;
                        // Where a part of the column is reached, the column up to there is that part.
                        for (const float part : {1e-4f, 0.3f, 0.9f}) {
                            const PassedColumn reached = follow(medium, ray, inside, part * found);
                            REQUIRE(reached.t <= inside.end);
                            CHECK(reached.column == part * found);
                            const float before =
                                column_of(medium, ray.origin, ray.direction, {inside.begin, reached.t});
                            const float rounding = grid.largest() * inside.end * 2e-7f; // of t
                            CHECK(std::abs(before - part * found) <= 1e-5f * found + rounding);
                        }
                        CHECK(follow(medium, ray, inside, 1.01f * found).t == kInfinity);
                        check_remembered_columns(medium, ray, inside, found);
                    }
                }
    }

    TEST_CASE("Rays along the planes and the sides of a grid pass a finite column") {
        Medium medium;
        medium.box = {{-1, -1, -1}, {1, 1, 1}};
        medium.density = std::make_shared<const DensityGrid>(std::array{3, 5, 9}, std::vector<float>(135, 2.0f));
        for (const Vec3 axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)})
            for (const Vec3 direction : {axis, -axis})
                for (const float a : {-1.0f, -0.5f, 0.0f, 1.0f})
                    for (const float b : {-1.0f, 0.25f, 1.0f}) {
                        const Vec3 aside = Vec3(axis.y, axis.z, axis.x) * a + Vec3(axis.z, axis.x, axis.y) * b;
                        for (const float back : {3.0f, 1.0f}) { // from before the box, and from its side
                            const Ray ray{aside - direction * back, direction};
                            const Interval inside = overlap(medium.box, ray, kInfinity);
                            CHECK(column_of(medium, ray.origin, ray.direction, inside) == doctest::Approx(4));
                        }
                    }
    }

    TEST_CASE("Boxes that floats can hardly hold have columns without invalid numbers") {
        const std::vector<float> densities(8, 1.0f);
        const Box3 boxes[] = {{{0, -1, -1}, {1e-38f, 1, 1}},
                              {{0, 0, 0}, {1e-45f, 1e-45f, 1e-45f}},
                              {{-1e18f, -1e18f, -1e18f}, {1e18f, 1e18f, 1e18f}},
                              {{1e6f, -1, -1}, {1e6f + 0.0625f, 1, 1}}};
        for (const Box3& box : boxes) {
            Medium medium;
            medium.box = box;
            medium.density = std::make_shared<const DensityGrid>(std::array{2, 2, 2}, densities);
            for (const Vec3 direction : {Vec3(1, 0, 0), Vec3(0, -1, 0), normalize(Vec3(1, 1, 1)), Vec3(0, 0, 1)})
                for (const Vec3 origin : {box.low, box.high, box.center(), box.low - direction}) {
                    const Ray ray{origin, direction};
                    const Interval inside = overlap(box, ray, kInfinity);
                    const float column = column_of(medium, ray.origin, ray.direction, inside);
                    CHECK(column >= 0);
                    CHECK(column <= 1.001f * std::max(inside.end - inside.begin, 0.0f));
                    const float density = density_at(medium, origin);
                    CHECK((density >= 0 && density <= 1));
                }
        }
        // A direction that is invalid has no column, and no cell outside of the grid is read.
        Medium medium;
        medium.box = {{-1, -1, -1}, {1, 1, 1}};
        medium.density = std::make_shared<const DensityGrid>(std::array{2, 2, 2}, densities);
        const Ray invalid{{0, 0, 0}, Vec3(NAN, 0, 1)};
        CHECK(follow(medium, invalid, {0, 1}, kInfinity).column == 0);
    }

    TEST_CASE("A cloud has densities in [0, 1], and none on the sides of its box") {
        const Box3 box{{-2, 0, 1}, {2, 1, 3}};
        double before = -1;
        for (const float coverage : {0.0f, 0.5f, 1.0f}) {
            Cloud cloud;
            cloud.coverage = coverage;
            cloud.resolution = 24;
            const DensityGrid grid = make_cloud(cloud, box);
            CHECK(grid.size() == std::array{25, 7, 13});
            std::size_t i = 0;
            double sum = 0;
            for (int z = 0; z < grid.size()[2]; ++z)
                for (int y = 0; y < grid.size()[1]; ++y)
                    for (int x = 0; x < grid.size()[0]; ++x, ++i) {
                        const float density = grid.densities()[i];
                        sum += static_cast<double>(density);
                        const bool side = x == 0 || y == 0 || z == 0 || x + 1 == grid.size()[0] ||
                                          y + 1 == grid.size()[1] || z + 1 == grid.size()[2];
                        CHECK(density >= 0);
                        CHECK(density <= (side ? 0 : 1));
                    }
            const double mean = sum / static_cast<double>(i);
            CHECK(mean > before);
            before = mean;
            if (coverage == 0) CHECK(mean < 0.02);
            if (coverage == 1) CHECK(mean > 0.25);
        }
    }
}
