// These tests check the emission and the sampling of lights.
#include "common/light/light.h"
#include "compare/stress/chi_squared.h"
#include "tests/support/form_factor.h"
#include "raytrace/sampling/light_sampler.h"
#include "raytrace/sampling/sampler.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

using namespace duet;
using Triangle = SurfaceLight::Triangle;

namespace {

SurfaceLight area_light(std::variant<Triangle, Quad, Sphere> shape, bool two_sided = false) {
    SurfaceLight light;
    light.shape = shape;
    light.two_sided = two_sided;
    light.radiance = Rgb(2, 1, 0.5f);
    return light;
}

struct Setting {
    std::string name;
    SurfaceLight light;
    Vec3 p, n;
};
/// Returns lights with points on their emitting side: far, near, in front of a corner, slanted, and partly below p's
/// horizon.
std::vector<Setting> settings() {
    // The triangle emits downward because its normal points down.
    const Triangle triangle{{-1, 2, -1}, {1, 2.2f, -0.5f}, {0.2f, 1.8f, 1.5f}};
    const Quad square{{-0.5f, 1, -0.5f}, {1, 0, 0}, {0, 0, 1}}; // normal (1,0,0) × (0,0,1) = −y
    const Quad slanted{{-1, 1, -1}, {2, 0.3f, 0}, {0.7f, 0, 2}};
    const Sphere ball{{0.3f, 2, -0.4f}, 0.7f};
    const Vec3 up{0, 1, 0}, tilted = normalize(Vec3(0.9f, 0.3f, -0.2f));
    return {{"triangle", area_light(triangle), {0, 0, 0}, up},
            {"triangle, near", area_light(triangle), {0.1f, 1.9f, -0.1f}, up},
            {"triangle, tilted", area_light(triangle), {0, 1, 0}, tilted},
            {"square", area_light(square), {0, 0, 0}, up},
            {"square, corner", area_light(square), {0.5f, 0.8f, 0.5f}, tilted},
            {"square, far", area_light(square), {3, -20, 1}, up},
            {"square, aside", area_light(square), {3, 0.9f, 0}, normalize(Vec3(-1, 0.2f, 0))},
            {"parallelogram", area_light(slanted), {0.2f, 0.3f, 0}, tilted},
            {"parallelogram, near", area_light(slanted), {0.2f, 1.0f, 0}, up},
            {"sphere", area_light(ball), {0, 0, 0}, up},
            {"sphere, near", area_light(ball), {0.3f, 1.299f, -0.4f}, tilted},
            {"sphere, dips below", area_light(ball), {0, 1.9f, 0.8f}, up},
            {"sphere, far", area_light(ball), {100, -300, 20}, up}};
}

/// Returns where a ray from p meets the shape's plane or surface, computed independently of the code under test.
std::optional<Vec3d> meet(const Triangle& t, Vec3d p, Vec3d w, bool parallelogram) {
    const Vec3d a(t.a), e1 = Vec3d(t.b) - a, e2 = Vec3d(t.c) - a, n = cross(e1, e2);
    const double distance = dot(n, a - p) / dot(n, w);
    if (!(distance > 0)) return std::nullopt;
    const Vec3d q = p + w * distance;
    const double u = dot(cross(q - a, e2), n) / dot(n, n), v = dot(cross(e1, q - a), n) / dot(n, n);
    const bool inside = u >= 0 && v >= 0 && (parallelogram ? u <= 1 && v <= 1 : u + v <= 1);
    return inside ? std::optional<Vec3d>(q) : std::nullopt;
}
std::optional<Vec3d> meet(const SurfaceLight& light, Vec3d p, Vec3d direction) {
    const Vec3d w = normalize(direction); // a float unit vector is normalized to only seven digits
    if (const auto* t = std::get_if<Triangle>(&light.shape)) return meet(*t, p, w, false);
    if (const auto* q = std::get_if<Quad>(&light.shape))
        return meet(Triangle{q->corner, q->corner + q->u, q->corner + q->v}, p, w, true);
    const auto& s = std::get<Sphere>(light.shape);
    const Vec3d f = p - Vec3d(s.center);
    const double b = dot(f, w), r2 = sqr(static_cast<double>(s.radius)), discriminant = b * b - dot(f, f) + r2;
    if (discriminant < 0) return std::nullopt;
    const double near = -b - std::sqrt(discriminant), far = -b + std::sqrt(discriminant);
    if (!(far > 0)) return std::nullopt;
    return p + w * (near > 0 ? near : far);
}

Vec3 center(const SurfaceLight& light) {
    if (const auto* t = std::get_if<Triangle>(&light.shape)) return (t->a + t->b + t->c) / 3.0f;
    if (const auto* q = std::get_if<Quad>(&light.shape)) return q->corner + (q->u + q->v) * 0.5f;
    return std::get<Sphere>(light.shape).center;
}

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("point, spot and sun") {
        const Light point = PointLight{{1, 2, 3}, Rgb(4, 8, 12)};
        const auto s = sample_light(point, {1, 0, 3}, {0.5f, 0.5f});
        REQUIRE(s.has_value());
        CHECK(s->wi == Vec3(0, 1, 0));
        CHECK(s->distance == 2);
        CHECK(s->radiance == Rgb(1, 2, 3));
        CHECK(s->delta);
        CHECK(s->pdf == 1);
        CHECK_FALSE(sample_light(point, {1, 2, 3}, {0, 0}).has_value());

        const float inner = std::cos(0.3f), outer = std::cos(0.5f);
        const Light spot = SpotLight{{0, 5, 0}, {0, -1, 0}, Rgb(25.0f), inner, outer};
        const auto at = [&](float angle) {
            const Vec3 w{std::sin(angle), -std::cos(angle), 0};
            const auto found = sample_light(spot, Vec3(0, 5, 0) + w * 5.0f, {});
            return found ? found->radiance.r : 0.0f;
        };
        CHECK(at(0) == doctest::Approx(1));
        CHECK(at(0.29f) == doctest::Approx(1));
        CHECK(at(std::acos(0.5f * (inner + outer))) == doctest::Approx(0.5).epsilon(1e-4));
        CHECK(at(0.51f) == 0);
        CHECK(at(3.1f) == 0);
        const Light hard = SpotLight{{0, 5, 0}, {0, -1, 0}, Rgb(25.0f), outer, outer};
        CHECK(sample_light(hard, {0, 0, 0}, {})->radiance == Rgb(1.0f));
        CHECK_FALSE(sample_light(hard, {9, 0, 0}, {}).has_value());

        const Light sun = SunLight{{0, -1, 0}, Rgb(3.0f)};
        CHECK(sample_light(sun, {7, 8, 9}, {})->distance == kInfinity);
        CHECK(sample_light(sun, {7, 8, 9}, {})->radiance == Rgb(3.0f));
        CHECK(sample_light(sun, {7, 8, 9}, {})->wi == Vec3(0, 1, 0));
    }

    TEST_CASE("power: flux in watts") {
        CHECK(light_power(PointLight{{}, Rgb(1, 2, 3)}, 1) == doctest::Approx(4 * kPiDouble * 2));
        CHECK(light_power(SunLight{{0, -1, 0}, Rgb(2.0f)}, 10) == doctest::Approx(200 * kPiDouble));
        CHECK(light_power(area_light(Quad{{}, {2, 0, 0}, {1, 3, 0}}), 1) == doctest::Approx(kPiDouble * 6 * 3.5 / 3));
        CHECK(light_power(area_light(Triangle{{}, {2, 0, 0}, {1, 3, 0}}, true), 1) ==
              doctest::Approx(kPiDouble * 6 * 3.5 / 3));
        CHECK(light_power(area_light(Sphere{{}, 2}), 1) == doctest::Approx(kPiDouble * 16 * kPiDouble * 3.5 / 3));
        // The power of a spot light must equal the integral of its intensity.
        const SpotLight spot{{}, {0, 0, 1}, Rgb(2.0f), 0.9f, 0.4f};
        double sum = 0;
        constexpr int kSteps = 10'000;
        for (int i = 0; i < kSteps; ++i) {
            const float z = -1 + 2 * (static_cast<float>(i) + 0.5f) / kSteps;
            const auto s = sample_light(spot, {std::sqrt(1 - z * z), 0, z}, {});
            if (s) sum += static_cast<double>(s->radiance.r) * 4 * kPiDouble / kSteps;
        }
        CHECK(light_power(spot, 1) == doctest::Approx(sum).epsilon(1e-3));
    }

    TEST_CASE("a sample's point lies on the light, its density is light_pdf's, at every scale") {
        for (const Setting& s : settings())
            for (const int exponent : {-20, 0, 20}) { // scales of 1e-6, 1 and 1e6
                const float scale = std::ldexp(1.0f, exponent);
                SurfaceLight light = s.light;
                if (auto* t = std::get_if<Triangle>(&light.shape)) *t = {t->a * scale, t->b * scale, t->c * scale};
                if (auto* q = std::get_if<Quad>(&light.shape)) *q = {q->corner * scale, q->u * scale, q->v * scale};
                if (auto* b = std::get_if<Sphere>(&light.shape)) *b = {b->center * scale, b->radius * scale};
                const Vec3 p = s.p * scale;
                CAPTURE(s.name);
                CAPTURE(exponent);
                for (const float x : {0.0f, 0.01f, 0.4f, 0.9f, kOneMinusEpsilon})
                    for (const float y : {0.0f, 0.03f, 0.5f, 0.8f, kOneMinusEpsilon}) {
                        const auto found = sample_light(light, p, {x, y});
                        REQUIRE(found.has_value());
                        REQUIRE((found->pdf > 0 && std::isfinite(found->pdf)));
                        REQUIRE(length(found->wi) == doctest::Approx(1).epsilon(1e-6));
                        REQUIRE(found->distance > 0);
                        REQUIRE_FALSE(found->delta);
                        REQUIRE(found->radiance == light.radiance);
                        const Vec3 q = p + found->wi * found->distance;
                        REQUIRE(light_pdf(light, p, q) == doctest::Approx(found->pdf).epsilon(1e-4));
                        // The point is moved slightly toward the center, so that rounding cannot push the ray past
                        // the rim.
                        const Vec3 inwards = normalize(q + (center(light) - q) * 1e-3f - p);
                        const auto met = meet(light, Vec3d(p), Vec3d(inwards));
                        REQUIRE(met.has_value());
                        const double gap = length(Vec3d(q) - *met);
                        REQUIRE(gap < 0.1 * static_cast<double>(length(center(light) - p)));
                    }
            }
    }

    TEST_CASE(
        "only the emitting side sends light; flat lights send none into their own plane; degenerate ones none at all") {
        const Quad quad{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}; // emits toward +z
        const Triangle triangle{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        const Vec2 u{0.3f, 0.4f};
        for (const SurfaceLight& one : {area_light(quad), area_light(triangle)}) {
            SurfaceLight both = one;
            both.two_sided = true;
            const Vec3 front{0.2f, 0.2f, 1}, back{0.2f, 0.2f, -1}, beside{3, 0.2f, 0};
            CHECK(sample_light(one, front, u).has_value());
            CHECK_FALSE(sample_light(one, back, u).has_value());
            CHECK(light_pdf(one, back, {0.3f, 0.3f, 0}) == 0);
            CHECK(sample_light(both, back, u).has_value());
            CHECK_FALSE(sample_light(both, beside, u).has_value());
            CHECK(is_black(surface_light_irradiance(both, beside, {-1, 0, 0})));
            CHECK(is_black(surface_light_irradiance(one, back, {0, 0, 1})));
        }
        const SurfaceLight ball = area_light(Sphere{{}, 1});
        SurfaceLight inwards = ball;
        inwards.two_sided = true;
        CHECK(sample_light(ball, {0, 0, 2}, u).has_value());
        CHECK_FALSE(sample_light(ball, {0, 0, 0.5f}, u).has_value());
        CHECK(sample_light(inwards, {0, 0, 0.5f}, u).has_value());
        CHECK(sample_light(inwards, {0, 0, 0.5f}, u)->pdf == doctest::Approx(1 / (4 * kPiDouble)));
        CHECK(surface_light_irradiance(inwards, {0, 0, 0.5f}, {0, 1, 0}).r == doctest::Approx(2 * kPiDouble));
        CHECK_FALSE(sample_light(area_light(Sphere{{}, 0}, true), {0, 0, 2}, u).has_value());
        CHECK_FALSE(sample_light(area_light(Quad{{}, {1, 0, 0}, {2, 0, 0}}, true), {0, 0, 2}, u).has_value());
        CHECK_FALSE(sample_light(area_light(Triangle{}, true), {0, 0, 2}, u).has_value());
    }
}

TEST_SUITE("statistical") {
    TEST_CASE("directions to each light are distributed as light_pdf says, which integrates to 1") {
        const auto all = settings();
        for (const Setting& s : all) { // false alarm odds: 1e-4 for all settings together
            CAPTURE(s.name);
            // These lights are smaller or thinner than the test's cells. The next test case covers them.
            if (s.name.ends_with("far") || s.name.ends_with("aside")) continue;
            compare::DirectionTest setup;
            setup.axis =
                // The axis is tilted so that no ring of cells follows a rim.
                normalize(normalize(center(s.light) - s.p) + Vec3(0.05f, 0.02f, -0.03f));
            setup.axis_power = 2;
            setup.samples = 50'000;
            setup.subdivisions = 20; // the rim crosses cells
            const auto result = compare::test_directions(
                setup,
                [&](Vec2 u) -> std::optional<Vec3> {
                    const auto found = sample_light(s.light, s.p, u);
                    return found ? std::optional<Vec3>(found->wi) : std::nullopt;
                },
                [&](Vec3 w) {
                    const auto q = meet(s.light, Vec3d(s.p), Vec3d(w));
                    return q ? static_cast<double>(light_pdf(s.light, s.p, Vec3(*q))) : 0.0;
                });
            CHECK(result.integral == doctest::Approx(1).epsilon(4e-3));
            CHECK_MESSAGE(result.chi_squared.p_value > compare::sidak_level(1e-4, static_cast<int>(all.size())),
                          result.chi_squared.details);
        }
    }

    TEST_CASE("sampled irradiance is Lambert's") {
        // The tolerance is 4.5 standard errors, so a false alarm has odds of 7e-6 per setting. The error is far below
        // 1 % for a light that is far and above the horizon.
        for (const Setting& s : settings()) {
            constexpr int kSamples = 40'000;
            Sampler sampler(SamplerKind::kIndependent, 5, kSamples);
            double sum = 0, squares = 0;
            for (int i = 0; i < kSamples; ++i) {
                sampler.start(0, 0, static_cast<std::uint32_t>(i));
                const auto found = sample_light(s.light, s.p, sampler.get_2d());
                if (!found) continue;
                const double value =
                    static_cast<double>(found->radiance.g * std::max(0.0f, dot(found->wi, s.n)) / found->pdf);
                sum += value / kSamples;
                squares += value * value / kSamples;
            }
            const double exact = static_cast<double>(surface_light_irradiance(s.light, s.p, s.n).g);
            CAPTURE(s.name);
            CAPTURE(sum);
            CAPTURE(exact);
            CHECK(exact > 0);
            CHECK(std::abs(sum - exact) < 4.5 * std::sqrt((squares - sum * sum) / kSamples) + 1e-6 * exact);
        }
    }
}
