// These tests check the sampling of spherical triangles and rectangles, near and far and at any slant.
#include "common/light/light.h"
#include "common/light/solid_angle.h"
#include "common/light/spherical_rectangle.h"
#include "common/light/spherical_triangle.h"
#include "common/sampling/hash.h"
#include "compare/stress/chi_squared.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace duet;

namespace {

/// Returns number i of a fixed random stream, in [0, 1).
double number(std::uint64_t i) { return static_cast<double>(unit_float(high_bits(stream_number(99, i)))); }
Vec3d vector(std::uint64_t i) { return {2 * number(3 * i) - 1, 2 * number(3 * i + 1) - 1, 2 * number(3 * i + 2) - 1}; }

/// Returns whether w is inside, up to rounding: it must be on the same side of the planes of all edges.
bool contains(const SphericalTriangle& t, Vec3d w) {
    const double side = dot(t.a, cross(t.b, t.c)) > 0 ? 1 : -1, bound = -1e-7;
    return side * dot(w, cross(t.a, t.b)) > bound && side * dot(w, cross(t.b, t.c)) > bound &&
           side * dot(w, cross(t.c, t.a)) > bound;
}

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("solid angles: an octant, tiny, needle-shaped and nearly a hemisphere") {
        CHECK(SphericalTriangle{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}.solid_angle() ==
              doctest::Approx(kPiDouble / 2).epsilon(1e-15));
        for (const double size : {1e-2, 1e-5, 1e-8}) {
            const SphericalTriangle t{{0, 0, 1}, normalize(Vec3d(size, 0, 1)), normalize(Vec3d(0, size, 1))};
            CHECK(t.solid_angle() == doctest::Approx(size * size / 2).epsilon(size * size * 2 + 1e-7));
        }
        const auto ring = [](double angle, double lift) {
            return normalize(Vec3d(std::cos(angle), std::sin(angle), lift));
        };
        const SphericalTriangle wide{ring(0, 1e-9), ring(2.1, 1e-9), ring(4.2, 1e-9)};
        CHECK(wide.solid_angle() == doctest::Approx(2 * kPiDouble).epsilon(1e-7));
        CHECK(SphericalTriangle{{1, 0, 0}, {1, 0, 0}, {0, 1, 0}}.solid_angle() == 0);
    }

    TEST_CASE("samples lie in their triangle, also at the corners of the square") {
        int tested = 0;
        for (std::uint64_t i = 0; i < 3000; ++i) {
            const SphericalTriangle t{normalize(vector(3 * i)), normalize(vector(3 * i + 1)),
                                      normalize(vector(3 * i + 2))};
            const double omega = t.solid_angle();
            if (omega < 1e-4 || omega > 6.2) continue;
            ++tested;
            for (const double x : {0.0, 0.3, static_cast<double>(kOneMinusEpsilon), 1.0})
                for (const double y : {0.0, 0.6, static_cast<double>(kOneMinusEpsilon)}) {
                    const Vec3d w = t.sample(omega, {x, y});
                    REQUIRE(std::abs(length(w) - 1) < 1e-9);
                    REQUIRE(contains(t, w));
                }
        }
        CHECK(tested > 2500);
    }

    TEST_CASE("spherical rectangles: the solid angle is that of two triangles, samples lie on the rectangle") {
        for (std::uint64_t i = 0; i < 2000; ++i) {
            const Vec3d x = normalize(vector(4 * i)), u = x * (0.1 + number(i)), corner = vector(4 * i + 1);
            const Vec3d v = normalize(cross(x, vector(4 * i + 2))) * (0.1 + 2 * number(i + 5000));
            if (std::abs(dot(corner, normalize(cross(u, v)))) < 1e-3) continue;
            const SphericalRectangle rectangle(corner, u, v);
            const auto triangle = [](Vec3d a, Vec3d b, Vec3d c) {
                return SphericalTriangle{normalize(a), normalize(b), normalize(c)}.solid_angle();
            };
            const Vec3d opposite = corner + u + v;
            const double expected = triangle(corner, corner + u, opposite) + triangle(corner, opposite, corner + v);
            REQUIRE(rectangle.solid_angle() == doctest::Approx(expected).epsilon(1e-9));
            for (const double a : {0.0, 0.3, static_cast<double>(kOneMinusEpsilon)})
                for (const double b : {0.0, 0.7, static_cast<double>(kOneMinusEpsilon)}) {
                    const Vec3d w = rectangle.sample({a, b}) - corner;
                    const double along_u = dot(w, u) / dot(u, u), along_v = dot(w, v) / dot(v, v);
                    REQUIRE((along_u > -1e-9 && along_u < 1 + 1e-9 && along_v > -1e-9 && along_v < 1 + 1e-9));
                    REQUIRE(length(w - u * along_u - v * along_v) < 1e-9);
                    // The fraction of the solid angle to the left of the sample must equal its first coordinate.
                    if (a != 0.3) continue;
                    REQUIRE(SphericalRectangle(corner, u * along_u, v).solid_angle() ==
                            doctest::Approx(a * expected).epsilon(1e-6));
                }
        }
        // A rectangle faces the point. The sample (½, ½) must be its center, and a quarter of the unit square must
        // fill a quarter of it.
        const SphericalRectangle straight({-1, -2, -3}, {2, 0, 0}, {0, 4, 0});
        CHECK(length(straight.sample({0.5, 0.5}) - Vec3d(0, 0, -3)) < 1e-12);
    }

    TEST_CASE(
        "lights at any place, near or far, edge-on or full: what is drawn is finite, in reach, with its own density") {
        int drawn = 0;
        for (std::uint64_t i = 0; i < 20'000; ++i) {
            // The distance is 1e-3 to 1e3 times the rectangle's extent.
            const double reach = std::pow(10.0, 6 * number(i + 1'000'000) - 3);
            const Vec3 p(vector(5 * i) * reach + Vec3d(0.3, 0.2, 0));
            const SurfaceLight::Triangle triangle{Vec3(vector(5 * i + 1)), Vec3(vector(5 * i + 2)),
                                                  Vec3(vector(5 * i + 3))};
            const Quad quad{triangle.a, triangle.b - triangle.a, triangle.c - triangle.a};
            const Vec2d u{number(2 * i + 2'000'000), number(2 * i + 2'000'001)};
            const auto check = [&](const auto& shape) {
                const auto s = sample_solid_angle(shape, Vec3d(p), u);
                if (!s) return;
                ++drawn;
                REQUIRE(std::abs(length(s->wi) - 1) < 1e-12);
                REQUIRE((s->distance > 0 && s->distance < 10 * (1 + reach)));
                REQUIRE((s->pdf > 0 && std::isfinite(s->pdf)));
                const Vec3d q = Vec3d(p) + s->wi * s->distance;
                REQUIRE(solid_angle_pdf(shape, Vec3d(p), q) == doctest::Approx(s->pdf).epsilon(1e-6));
            };
            check(triangle);
            check(quad);
        }
        CHECK(drawn > 39'900);
    }
}

TEST_SUITE("statistical") {
    TEST_CASE("directions are uniform over spherical rectangles") { // false alarm odds: 1e-4 for all together
        struct Case {
            Vec3d corner, u, v;
        };
        const Case cases[] = {{{-0.5, -0.5, -1}, {1, 0, 0}, {0, 1, 0}},
                              {{0.2, 0.1, 0.3}, {3, 0, 0}, {0, 0, 2}},
                              {{-4, -0.1, -0.2}, {8, 0, 0}, {0, 5, 0}}};
        for (const Case& c : cases) {
            const SphericalRectangle rectangle(c.corner, c.u, c.v);
            const Vec3d n = cross(c.u, c.v);
            compare::DirectionTest setup;
            setup.axis = normalize(Vec3(normalize(c.corner + (c.u + c.v) * 0.5)) + Vec3(0.05f, 0.02f, -0.03f));
            setup.subdivisions = 100; // edges cross cells, and no ring of cells may follow an edge
            const auto result = compare::test_directions(
                setup, [&](Vec2 u) { return Vec3(normalize(rectangle.sample(Vec2d(u)))); },
                [&](Vec3 w) {
                    const double t = dot(c.corner, n) / dot(Vec3d(w), n);
                    const Vec3d q = Vec3d(w) * t - c.corner;
                    const double a = dot(q, c.u) / dot(c.u, c.u), b = dot(q, c.v) / dot(c.v, c.v);
                    return t > 0 && a >= 0 && a < 1 && b >= 0 && b < 1 ? 1 / rectangle.solid_angle() : 0.0;
                });
            CHECK(result.integral == doctest::Approx(1).epsilon(3e-3));
            CHECK_MESSAGE(result.chi_squared.p_value > compare::sidak_level(1e-4, 3), result.chi_squared.details);
        }
    }

    TEST_CASE("directions are uniform over spherical triangles") { // false alarm odds: 1e-4 for all together
        const SphericalTriangle triangles[] = {
            {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
            {normalize(Vec3d(1, 0.1, 0)), normalize(Vec3d(-1, 1, 0.1)), normalize(Vec3d(-0.7, -1, 0.4))},
            {normalize(Vec3d(1, 0, 0.5)), normalize(Vec3d(0.8, 0.6, 0.4)), normalize(Vec3d(-0.1, 0.2, 1))}};
        for (const SphericalTriangle& t : triangles) {
            const double omega = t.solid_angle();
            compare::DirectionTest setup;
            setup.axis = Vec3(normalize(t.a + t.b + t.c));
            setup.subdivisions = 20; // edges cross cells
            const auto result = compare::test_directions(
                setup, [&](Vec2 u) { return Vec3(t.sample(omega, Vec2d(u))); },
                [&](Vec3 w) { return contains(t, Vec3d(w)) ? 1 / omega : 0.0; });
            CHECK(result.integral == doctest::Approx(1).epsilon(3e-3));
            CHECK_MESSAGE(result.chi_squared.p_value > compare::sidak_level(1e-4, 3), result.chi_squared.details);
        }
    }
}
