// Lesson raytrace-09: places on a sphere, texels, cubes and noise are the library's.
#include "common/geometry/sphere.h"
#include "common/texture/noise.h"
#include "common/texture/texture.h"
#include "raytrace/lessons/05-diffuse/diffuse.h"
#include "raytrace/lessons/09-textures/textures.h"

#include <doctest/doctest.h>

using namespace duet;

namespace {

/// The gradient of the library's noise at a lattice point, from its values near by. There the noise is g·d up to terms
/// of the third power of d; kLargest is what the library divides it by.
constexpr double kLargest = 1.0363538112118;
Vec3d library_gradient(Vec3d corner) {
    constexpr double kStep = 0x1p-20;
    const auto along = [&](Vec3d axis) { return std::round(gradient_noise(corner + axis * kStep) * kLargest / kStep); };
    return {along({1, 0, 0}), along({0, 1, 0}), along({0, 0, 1})};
}

} // namespace

TEST_SUITE("lesson") {

    TEST_CASE("raytrace-09: a place on the globe is the library's, and leads back to the normal") {
        lesson::Random random(9);
        for (int i = 0; i < 20'000; ++i) {
            const Vec3 n = lesson::random_unit_vector(random);
            const Vec2 naive = lesson::sphere_uv(n), library = sphere_uv(n);
            if (std::abs(n.x) > 1e-4f || n.z > 0) // on the seam u may be 0 or 1
                REQUIRE(std::abs(naive.x - library.x) < 1e-6f);
            // Near a pole the arcsine of a rounded number is off by the root of that rounding, 2^-24, and more.
            REQUIRE(std::abs(naive.y - library.y) < (std::abs(n.y) < 0.99f ? 1e-6f : 3e-4f));
            REQUIRE(length(lesson::sphere_normal(naive) - n) < (std::abs(n.y) < 0.99f ? 2e-6f : 1e-3f));
        }
    }

    TEST_CASE("raytrace-09: texels of an image that repeats around are the library's") {
        lesson::Random random(90);
        TextureSet set;
        set.images.push_back(ImageRgb(13, 8));
        for (Rgb& pixel : set.images.edit(0).pixels()) pixel = Rgb(random.next(), random.next(), random.next());
        const ImageTexture texture{.image = 0, .scale = {1, 1}, .filter = TextureFilter::kNearest};
        int compared = 0;
        for (int i = 0; i < 20'000; ++i) {
            const float u = 6 * random.next() - 3;
            const Vec2 uv{u, random.next()};
            const auto from_edge = [](float x) { return std::abs(x - std::round(x)); };
            if (from_edge(uv.x * 13) < 1e-4f || from_edge(uv.y * 8) < 1e-4f) continue; // rounding decides
            SurfacePoint point{};
            point.uv = uv;
            REQUIRE(lesson::image_color(set.images[0], uv) == evaluate_texture(set, texture, point));
            ++compared;
        }
        CHECK(compared > 19'000);
        CHECK(lesson::image_color(set.images[0], {1, 1}) == set.images[0](0, 0));
        CHECK(lesson::image_color(set.images[0], {0, 0}) == set.images[0](0, 7));
        CHECK(lesson::image_color(set.images[0], {0.5f, -2}) == set.images[0](6, 7)); // beyond the pole
    }

    TEST_CASE("raytrace-09: cubes are dark where the library's are") {
        lesson::Random random(900);
        const CheckerTexture texture{.even = Rgb(0), .odd = Rgb(1), .scale = 1, .solid = true};
        int dark = 0, compared = 0;
        for (int i = 0; i < 20'000; ++i) {
            const auto coordinate = [&] { return 12 * random.next() - 6; };
            const float x = coordinate(), y = coordinate();
            SurfacePoint point{};
            point.p_object = {x, y, coordinate()};
            const auto from_edge = [](float a) { return std::abs(a - std::round(a)); };
            const Vec3 p = point.p_object;
            if (min(min(from_edge(p.x), from_edge(p.y)), from_edge(p.z)) < 1e-3f) continue; // the library shifts cubes
            const bool naive = lesson::checker(p);
            REQUIRE(naive == (evaluate_texture({}, texture, point).r > 0.5f));
            dark += naive, ++compared;
        }
        CHECK(compared > 19'000);
        CHECK(dark > 0.48 * compared); // a half: 0.48 is 5 standard deviations off
        CHECK(dark < 0.52 * compared);
    }

    TEST_CASE("raytrace-09: with the library's gradients, the noise is the library's") {
        lesson::Random random(9000);
        double largest = 0;
        for (int i = 0; i < 3000; ++i) {
            const auto coordinate = [&] { return 20 * random.next() - 10; };
            const float x = coordinate(), y = coordinate();
            const Vec3 p{x, y, coordinate()};
            const auto slope = [](Vec3 c, Vec3 d) { return dot(Vec3(library_gradient(Vec3d(c))), d); };
            const double naive = static_cast<double>(lesson::lattice_noise(p, slope, lesson::fade));
            REQUIRE(std::abs(naive / kLargest - gradient_noise(Vec3d(p))) < 2e-6);
            largest = std::max(largest, std::abs(naive));
        }
        CHECK(largest > 0.5); // else nothing was compared
    }

    TEST_CASE("raytrace-09: the lesson's own noise is 0 on the lattice, has twelve slopes there, and no seam") {
        lesson::Random random(90'000);
        std::array<int, 27> seen{};
        for (int i = 0; i < 6000; ++i) {
            const auto whole = [&] { return std::floor(200 * random.next()) - 100; };
            const float x = whole(), y = whole();
            const Vec3 c{x, y, whole()};
            REQUIRE(lesson::gradient_noise(c) == 0);
            const Vec3 g{lesson::corner_slope(c, {1, 0, 0}), lesson::corner_slope(c, {0, 1, 0}),
                         lesson::corner_slope(c, {0, 0, 1})};
            REQUIRE(dot(g, g) == 2);
            ++seen[static_cast<std::size_t>(9 * (g.x + 1) + 3 * (g.y + 1) + g.z + 1)];
            // On both sides of a plane of the lattice the noise and its slope along x agree: the slope differs by at
            // most its derivative, below 30, times the distance of the points.
            const auto noise = [&](float dx) { return lesson::gradient_noise(c + Vec3{dx, 0.3f, 0.6f}); };
            constexpr float kStep = 0x1p-9f;
            REQUIRE(std::abs(noise(kStep) - noise(-kStep)) < 8 * kStep);
            const float before = (noise(0) - noise(-kStep)) / kStep, after = (noise(kStep) - noise(0)) / kStep;
            REQUIRE(std::abs(before - after) < 30 * kStep + 0.02f);
        }
        int gradients = 0;
        for (const int count : seen)
            if (count > 0) {
                ++gradients;
                // 500 expected of 6000, with a standard deviation of 21.4: 6 of them.
                CHECK(count > 500 - 129);
                CHECK(count < 500 + 129);
            }
        CHECK(gradients == 12);
    }
}
