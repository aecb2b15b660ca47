// These tests check the light tree: its bounds miss no light, and its probabilities match its samples.
#include "compare/stress/chi_squared.h"
#include "tests/support/form_factor.h"
#include "raytrace/sampling/light_sampler.h"
#include "raytrace/sampling/sampler.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

using namespace duet;

namespace {

Vec3 in_cube(Sampler& s, float half) {
    const auto u = s.get_block();
    return (Vec3(u[0], u[2], u[4]) * 2.0f - Vec3(1, 1, 1)) * half;
}

Light random_light(Sampler& s, float size) {
    const Vec3 p = in_cube(s, 5), u = in_cube(s, size), v = in_cube(s, size);
    const float kind = s.get_2d().x;
    SurfaceLight light;
    light.radiance = Rgb(std::exp(8 * s.get_2d().x - 4));
    light.two_sided = s.get_2d().x < 0.3f;
    if (kind < 0.4f)
        light.shape = Quad{p, u, v};
    else if (kind < 0.7f)
        light.shape = SurfaceLight::Triangle{p, p + u, p + v};
    else if (kind < 0.85f)
        light.shape = Sphere{p, length(u)};
    else
        return PointLight{p, light.radiance};
    return light;
}

std::vector<Light> random_lights(std::size_t n, std::uint64_t seed, float size = 0.3f) {
    Sampler s(SamplerKind::kIndependent, seed, 1);
    std::vector<Light> lights;
    for (std::uint32_t i = 0; i < n; ++i) {
        s.start(0, 0, i);
        lights.push_back(random_light(s, size));
    }
    return lights;
}

LightReceiver random_receiver(Sampler& s) {
    const Vec3 p = in_cube(s, 6), n = in_cube(s, 1);
    return {p, s.get_2d().x < 0.2f ? Vec3() : normalize(n)};
}

/// Returns whether the light can reach the receiver, ignoring shadows.
bool can_light(const Light& light, const LightReceiver& receiver) {
    if (const auto* point = std::get_if<PointLight>(&light))
        return receiver.n == Vec3() || dot(point->position - receiver.p, receiver.n) > 0;
    const auto& surface = std::get<SurfaceLight>(light);
    if (receiver.n == Vec3()) return emits_towards(surface, receiver.p);
    return surface_light_irradiance(surface, receiver.p, receiver.n).r > 1e-6f * surface.radiance.r;
}

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("bounds of a set miss no light that any of it can send") {
        Sampler s(SamplerKind::kIndependent, 5, 1);
        int lit = 0, dark = 0;
        for (std::uint32_t trial = 0; trial < 3000; ++trial) {
            const auto lights = random_lights(1 + trial % 5, trial, trial % 2 == 0 ? 0.2f : 3.0f);
            LightBounds all;
            for (const Light& light : lights) all.extend(light_bounds(light));
            s.start(1, 0, trial);
            const LightReceiver receiver = random_receiver(s);
            const float estimate = irradiance_estimate(all, receiver);
            REQUIRE(std::isfinite(estimate));
            dark += estimate == 0;
            for (const Light& light : lights) {
                if (!can_light(light, receiver)) continue;
                ++lit;
                REQUIRE(irradiance_estimate(light_bounds(light), receiver) > 0);
                REQUIRE(estimate > 0);
            }
        }
        CHECK(lit > 1000);
        CHECK(dark > 100); // the bounds do exclude some lights
    }

    TEST_CASE("a cone about cones holds them") {
        Sampler s(SamplerKind::kIndependent, 6, 1);
        for (std::uint32_t trial = 0; trial < 5000; ++trial) {
            s.start(0, 0, trial);
            LightBounds a, b;
            a.axis = normalize(in_cube(s, 1));
            b.axis = trial % 50 == 0 ? -a.axis : trial % 50 == 1 ? a.axis : normalize(in_cube(s, 1));
            const float half_a = s.get_2d().x * kPi, half_b = s.get_2d().x * s.get_2d().x * kPi;
            a.cos_normals = std::cos(half_a);
            b.cos_normals = std::cos(half_b);
            a.box.extend(Vec3());
            b.box.extend(Vec3());
            LightBounds both = a;
            both.extend(b);
            if (both.cos_normals <= -1) continue;
            const auto angle = [](Vec3 v, Vec3 w) { return 2 * std::atan2(length(v - w), length(v + w)); };
            const float half = std::acos(both.cos_normals);
            const float room = 1e-3f; // tolerance: a cosine near 1 has only half of an angle's digits
            REQUIRE(angle(both.axis, a.axis) + half_a <= half + room);
            REQUIRE(angle(both.axis, b.axis) + half_b <= half + room);
        }
    }

    TEST_CASE("the tree's probabilities are those of its samples, add up to 1, and the number left over is fresh") {
        for (const std::size_t n : {1u, 2u, 8u, 9u, 100u, 1000u}) {
            CAPTURE(n);
            const auto lights = random_lights(n, n);
            const LightSampler chooser(lights, 0);
            Sampler s(SamplerKind::kIndependent, 8, 1);
            for (std::uint32_t trial = 0; trial < 20; ++trial) {
                s.start(2, 0, trial);
                const LightReceiver receiver = random_receiver(s);
                double sum = 0;
                for (std::size_t i = 0; i < n; ++i) {
                    const float p = chooser.probability(receiver, i);
                    sum += static_cast<double>(p);
                    if (can_light(lights[i], receiver)) REQUIRE(p > 0);
                }
                const bool any = chooser.sample(receiver, 0.5f).has_value();
                if (any && n <= LightTree::kLeafLights) CHECK(sum == doctest::Approx(1).epsilon(1e-5));
                // An inner node with a positive bound may have only leaves that contribute nothing.
                CHECK(sum <= 1 + 1e-4);
                double remapped = 0;
                int chosen = 0;
                for (int i = 0; i < 4000; ++i) {
                    const auto choice = chooser.sample(receiver, (static_cast<float>(i) + 0.5f) / 4000);
                    if (!choice) continue;
                    ++chosen;
                    REQUIRE(choice->probability ==
                            doctest::Approx(chooser.probability(receiver, choice->index)).epsilon(1e-4));
                    REQUIRE((choice->remapped >= 0 && choice->remapped < 1));
                    remapped += static_cast<double>(choice->remapped);
                }
                CHECK(chosen == doctest::Approx(4000 * sum).epsilon(2e-3));
                if (chosen > 0 && n <= 8) CHECK(remapped / chosen == doctest::Approx(0.5).epsilon(0.01));
            }
        }
    }

    TEST_CASE("a near light is chosen before a far one, and none behind the receiver") {
        const std::vector<Light> lights{PointLight{{1, 0, 0}, Rgb(1.0f)}, PointLight{{10, 0, 0}, Rgb(1.0f)},
                                        PointLight{{-1, 0, 0}, Rgb(100.0f)}, PointLight{{1, 1, 0}, Rgb(0.0f)}};
        const LightSampler chooser(lights, 0);
        const LightReceiver toward{{}, {1, 0, 0}};
        CHECK(chooser.probability(toward, 0) == doctest::Approx(100.0 / 101));
        CHECK(chooser.probability(toward, 1) == doctest::Approx(1.0 / 101));
        CHECK(chooser.probability(toward, 2) == 0);
        CHECK(chooser.probability(toward, 3) == 0); // its emission is black
        CHECK(chooser.probability(toward, 4) == 0);
        CHECK(chooser.probability({{}, {}}, 2) > 0.9f);
        CHECK_FALSE(chooser.sample({{20, 0, 0}, {1, 0, 0}}, 0.5f).has_value());
    }

    TEST_CASE("suns, the environment and all lights together share half of the samples evenly") {
        const std::vector<Light> lights{SunLight{{0, -1, 0}, Rgb(900.0f)}, PointLight{{0, 1, 0}, Rgb(1.0f)},
                                        SunLight{{0, 1, 0}, Rgb(5.0f)}};
        const LightSampler chooser(lights, 99);
        const LightReceiver up{{}, {0, 1, 0}};
        CHECK(chooser.environment_index() == 3);
        CHECK(chooser.probability(up, 0) == doctest::Approx(0.5 / 3 + 0.5 * 900 / 1000));
        CHECK(chooser.probability(up, 1) == doctest::Approx(0.5 / 3 + 0.5 * 1 / 1000));
        CHECK(chooser.probability(up, 2) == 0); // it emits from below
        CHECK(chooser.probability(up, 3) == doctest::Approx(0.5 / 3 + 0.5 * 99 / 1000));
        double counts[4]{};
        for (int i = 0; i < 10'000; ++i) {
            const auto choice = chooser.sample(up, (static_cast<float>(i) + 0.5f) / 10'000);
            REQUIRE(choice.has_value());
            REQUIRE(choice->probability == doctest::Approx(chooser.probability(up, choice->index)));
            counts[choice->index] += 1e-4;
        }
        for (std::size_t i = 0; i < 4; ++i)
            CHECK(counts[i] == doctest::Approx(chooser.probability(up, i)).epsilon(2e-3));
    }

    TEST_CASE("no lights, one, and lights of extreme scale") {
        CHECK(LightSampler({}, 0).empty());
        CHECK_FALSE(LightSampler({}, 0).sample({}, 0.5f).has_value());
        CHECK(LightSampler({}, 0).probability({}, 0) == 0);
        CHECK(LightSampler().empty());
        CHECK(LightSampler({}, 5).sample({}, 0.5f)->index == 0);
        CHECK(LightSampler({}, 5).probability({}, 0) == 1);
        const LightReceiver origin{{}, {0, 1, 0}};
        const float huge = std::numeric_limits<float>::max();
        const LightSampler bright({PointLight{{0, 1e-15f, 0}, Rgb(huge)}, PointLight{{0, 1e-15f, 0}, Rgb(huge)}}, 1);
        for (std::size_t i = 0; i < 3; ++i) CHECK(std::isfinite(bright.probability(origin, i)));
        CHECK(bright.sample(origin, 0.2f).has_value());
        // A thousand lights are at one position, so the tree must split them by index.
        const LightSampler heap(std::vector<Light>(1000, PointLight{{0, 1, 0}, Rgb(1.0f)}), 0);
        for (const std::size_t i : {0u, 7u, 999u})
            CHECK(heap.probability(origin, i) == doctest::Approx(1e-3).epsilon(0.1));
    }
}
