// Lesson raytrace-06: reflection and refraction by hand-computed angles, and as the library has them.
#include "common/material/dielectric.h"
#include "common/material/fresnel.h"
#include "raytrace/lessons/06-metal-and-glass/materials.h"

#include <doctest/doctest.h>

using namespace duet;

namespace {

/// The unit direction that arrives at an angle, in degrees, from the normal +z.
Vec3 arriving(double angle) { return Vec3(Vec3d(std::sin(radians(angle)), 0, -std::cos(radians(angle)))); }

/// The angle between a direction that leaves downward and -z, in degrees.
double angle_below(Vec3 d) { return degrees(std::atan2(static_cast<double>(d.x), static_cast<double>(-d.z))); }

} // namespace

TEST_SUITE("lesson") {

    TEST_CASE(
        "raytrace-06: the angle of reflection is that of incidence, and the library's reflect has the same bits") {
        const Vec3 at_45 = lesson::mirror({1, 0, -1}, {0, 0, 1});
        CHECK(at_45 == Vec3{1, 0, 1});
        lesson::Random random(1);
        for (int i = 0; i < 10'000; ++i) {
            const Vec3 n = lesson::random_unit_vector(random), d = lesson::random_unit_vector(random);
            const Vec3 mirrored = lesson::mirror(d, n);
            REQUIRE(mirrored == reflect(-d, n));
            REQUIRE(std::abs(dot(mirrored, n) + dot(d, n)) < 1e-6f);
            REQUIRE(std::abs(length(mirrored) - 1) < 1e-6f);
        }
    }

    TEST_CASE("raytrace-06: Snell's law for known indices") {
        struct Known {
            double ior, angle, beyond; ///< from air into the material; angles in degrees
        };
        // asin(sin 30° / 1.5) = asin(1/3) = 19.4712°, and so on; the page's table.
        for (const Known& known : {Known{1.5, 0, 0},
                                   {1.5, 30, 19.4712},
                                   {1.5, 45, 28.1255},
                                   {1.5, 60, 35.2644},
                                   {1.33, 45, 32.1176},
                                   {2.42, 45, 16.9893}}) {
            CAPTURE(known.ior);
            CAPTURE(known.angle);
            const Vec3 n{0, 0, 1};
            const auto into = lesson::refract(arriving(known.angle), n, static_cast<float>(1 / known.ior));
            REQUIRE(into);
            CHECK(angle_below(*into) == doctest::Approx(known.beyond).epsilon(1e-5));
            const auto out = lesson::refract(*into, n, static_cast<float>(known.ior)); // the same way back
            REQUIRE(out);
            CHECK(angle_below(*out) == doctest::Approx(known.angle).epsilon(1e-5));
        }
        // The critical angles of glass and water: asin(1/1.5) = 41.8103°, asin(1/1.33) = 48.7535°.
        CHECK(lesson::refract(arriving(41.80), {0, 0, 1}, 1.5f));
        CHECK(!lesson::refract(arriving(41.82), {0, 0, 1}, 1.5f));
        CHECK(lesson::refract(arriving(48.74), {0, 0, 1}, 1.33f));
        CHECK(!lesson::refract(arriving(48.76), {0, 0, 1}, 1.33f));
    }

    TEST_CASE("raytrace-06: the library's dielectric refracts as the lesson does") {
        lesson::Random random(2);
        int refracted = 0;
        for (int i = 0; i < 20'000; ++i) {
            const Vec3 wo = lesson::random_unit_vector(random);
            const float eta = 1 + 1.5f * random.next();
            const float ratio = wo.z > 0 ? 1 / eta : eta, sine2 = ratio * ratio * (1 - wo.z * wo.z);
            if (std::abs(wo.z) < 1e-3f || std::abs(sine2 - 1) < 1e-3f) continue; // rounding decides
            const auto bent = lesson::refract(-wo, {0, 0, wo.z > 0 ? 1.0f : -1.0f}, ratio);
            const auto sample =
                DielectricBsdf{eta, Rgb(1)}.sample(wo, kOneMinusEpsilon, {}, TransportMode::kImportance);
            REQUIRE(sample);
            REQUIRE(bent.has_value() == (sample->wi.z * wo.z < 0));
            if (!bent) continue;
            ++refracted;
            REQUIRE(length(*bent - sample->wi) < 5e-6f);
        }
        CHECK(refracted > 10'000);
    }

    TEST_CASE("raytrace-06: Schlick is within 4 percent of Fresnel's equations for glass") {
        float most = 0;
        for (float cosine = 0; cosine <= 1; cosine += 1 / 1024.0f)
            most = std::max(most, std::abs(lesson::schlick(cosine, 1.5f) - fresnel_dielectric(cosine, 1.5f)));
        CHECK(most < 0.04f);
        CHECK(most > 0.03f); // and no nearer
        CHECK(lesson::schlick(1, 1.5f) == doctest::Approx(0.04));
        CHECK(lesson::schlick(0.5f, 1.5f) == doctest::Approx(0.07)); // 60 degrees: 0.04 + 0.96 / 32
        CHECK(lesson::schlick(0, 1.5f) == doctest::Approx(1));
        CHECK(lesson::schlick(0.3f, 1.5f) == doctest::Approx(lesson::schlick(0.3f, 1 / 1.5f)));
    }

    TEST_CASE("raytrace-06: glass reflects the fraction of rays that Schlick's approximation says") {
        // Of 100 000 rays the count's standard deviation is at most 158; the limit is five of them, which chance
        // exceeds in one of 1.7 million runs. The numbers are the same in each run.
        const lesson::Material glass = lesson::glass(1.5f), bubble = lesson::glass(1 / 1.5f);
        lesson::Random random(4);
        const auto reflected = [&](const lesson::Material& material, double angle, bool front) {
            int count = 0;
            const Ray ray{{0, 0, 1}, arriving(angle) * 3.0f};
            for (int i = 0; i < 100'000; ++i)
                count +=
                    lesson::scatter(material, ray, {1, {0, 0, 0}, {0, 0, 1}, front, 0}, random)->ray.direction.z > 0;
            return count;
        };
        const auto expected = [](double angle_in_air) {
            return 100'000 * lesson::schlick(static_cast<float>(std::cos(radians(angle_in_air))), 1.5f);
        };
        const auto near = [](int count, float mean) { return std::abs(static_cast<float>(count) - mean) < 790; };
        CHECK(near(reflected(glass, 0, true), 4000));
        CHECK(near(reflected(glass, 80, true), expected(80)));
        CHECK(near(reflected(glass, 40, false), expected(74.6187))); // sin 40° · 1.5 = 0.9642
        CHECK(near(reflected(bubble, 40, true), expected(74.6187)));
        CHECK(reflected(glass, 42, false) == 100'000);
        CHECK(reflected(bubble, 42, true) == 100'000);
        CHECK(near(reflected(bubble, 80, false), expected(80)));
    }

    TEST_CASE("raytrace-06: a scattered ray has a direction of length 1, so that its t_min is a length") {
        lesson::Random random(6);
        for (const lesson::Material& material :
             {lesson::matte(Rgb(1)), lesson::metal(Rgb(1), 0.9f), lesson::glass(1.5f)}) {
            double shortest = 9, longest = 0;
            for (int i = 0; i < 20'000; ++i) {
                const auto scattered =
                    lesson::scatter(material, {{0, 0, 5}, {2, 0, -5}}, {1, {2, 0, 0}, {0, 0, 1}, true, 0}, random);
                if (!scattered) continue; // metal may absorb
                const double size = length(Vec3d(scattered->ray.direction));
                shortest = std::min(shortest, size), longest = std::max(longest, size);
            }
            CHECK(shortest > 1 - 1e-6);
            CHECK(longest < 1 + 1e-6);
        }
    }

    TEST_CASE("raytrace-06: between two mirrors that face each other a ray is reflected for ever") {
        const std::vector<lesson::Sphere> spheres{{{0, 0, -3}, 1}, {{0, 0, 3}, 1}};
        int tests = 0;
        const auto closest = [&](const Ray& ray) { return ++tests, lesson::closest_hit(spheres, ray); };
        lesson::Random random(5);
        const std::vector<lesson::Material> mirrors(2, lesson::metal(Rgb(1)));
        const Rgb color = lesson::path_color(closest, mirrors, {{0, 0, 0}, {0, 0, -1}}, 10'000, random);
        CHECK(tests == 10'001);
        CHECK(is_black(color));
    }
}
