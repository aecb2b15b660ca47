// Lesson raytrace-05: rays that leave a surface don't meet it again, and directions are those of the library.
#include "common/geometry/sphere.h"
#include "common/sampling/warp.h"
#include "raytrace/lessons/05-diffuse/diffuse.h"

#include <doctest/doctest.h>

using namespace duet;

TEST_SUITE("lesson") {

    TEST_CASE("raytrace-05: a point beyond the error is outside, whatever the scale") {
        lesson::Random random(3);
        int rays = 0, at_once = 0, beyond = 0, library = 0;
        while (rays < 400'000) {
            const float radius = std::pow(10.0f, 6 * random.next() - 3), away = std::pow(10.0f, 6 * random.next() - 3);
            const lesson::Sphere sphere{lesson::random_unit_vector(random) * away, radius};
            const Vec3 eye =
                sphere.center + lesson::random_unit_vector(random) * (radius * (1.01f + 5 * random.next()));
            const Vec3 target = sphere.center + lesson::random_unit_vector(random) * radius;
            const auto hit = lesson::closest_hit({sphere}, {eye, target - eye});
            if (!hit || !hit->front) continue;
            ++rays;
            const Vec3 direction = lesson::random_diffuse_direction(hit->n, random);
            const Vec3 origin = lesson::offset_point(sphere, *hit);
            at_once += lesson::hit_sphere(sphere, {hit->p, direction}).has_value();
            beyond += lesson::hit_sphere(sphere, {origin, direction}).has_value();
            library += intersect_sphere({origin, direction}, {sphere.center, radius}).has_value();
        }
        CHECK(at_once > rays / 4);
        CHECK(at_once < rays / 2);
        CHECK(beyond < rays / 100'000);
        CHECK(library < rays / 100'000);
    }

    TEST_CASE("raytrace-05: directions are as likely as the library's cosine_hemisphere makes them") {
        // The cosine's square is uniform in [0, 1) for both. Of 250 000 draws in sixteen bins the standard deviation of
        // a bin is 121; the limit is five of them.
        constexpr int kDraws = 250'000;
        lesson::Random random(5);
        std::array<int, 16> lesson_bins{}, library_bins{};
        for (int i = 0; i < kDraws; ++i) {
            const auto count = [](std::array<int, 16>& bins, float cosine) {
                ++bins[static_cast<std::size_t>(min(16 * cosine * cosine, 15.0f))];
            };
            count(lesson_bins, normalize(lesson::random_diffuse_direction({0, 0, 1}, random)).z);
            const float u = random.next(), v = random.next();
            count(library_bins, cosine_hemisphere(Vec2{u, v}).z);
        }
        for (const auto& bins : {lesson_bins, library_bins})
            for (const int bin : bins) CHECK(std::abs(bin - kDraws / 16) < 605);
    }
}
