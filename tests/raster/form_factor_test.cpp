// These tests compare closed-form irradiance with published values, laws, limits and hard cases.
#include "tests/support/form_factor.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <vector>

using namespace duet;

namespace {

double factor(Vec3 p, Vec3 n, std::vector<Vec3> polygon) { return polygon_form_factor_times_pi(p, n, polygon); }

std::vector<Vec3> rectangle(Vec3 corner, Vec3 u, Vec3 v) { return {corner, corner + u, corner + u + v, corner + v}; }

/// Integrates max(0, n·w) over the sphere's spherical cap with the midpoint rule in (1 − cos, φ) around the cap's
/// center.
double sphere_by_quadrature(double sine, double c) {
    constexpr int kRings = 400, kSectors = 400;
    const double gap = sine * sine / (1 + std::sqrt(1 - sine * sine)), s = std::sqrt(1 - c * c);
    double sum = 0;
    for (int i = 0; i < kRings; ++i)
        for (int j = 0; j < kSectors; ++j) {
            const double g = gap * (i + 0.5) / kRings, phi = 2 * kPiDouble * (j + 0.5) / kSectors;
            sum += std::max(0.0, (1 - g) * c + std::sqrt(g * (2 - g)) * std::cos(phi) * s);
        }
    return sum * 2 * kPiDouble * gap / (kRings * kSectors);
}

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("published configuration factors of rectangles") {
        // The values are factors B-3 and B-4 of Howell, "A Catalog of Radiation Heat Transfer Configuration Factors".
        // In B-3 an element faces a parallel rectangle a × b from below its corner at distance c. In B-4 the
        // element's plane is perpendicular to the rectangle.
        for (const double a : {0.1, 1.0, 7.0})
            for (const double b : {0.3, 1.0, 20.0})
                for (const double c : {0.01, 1.0, 5.0}) {
                    CAPTURE(a);
                    CAPTURE(b);
                    CAPTURE(c);
                    const float fa = static_cast<float>(a), fb = static_cast<float>(b), fc = static_cast<float>(c);
                    const double x = static_cast<double>(fa) / static_cast<double>(fc),
                                 y = static_cast<double>(fb) / static_cast<double>(fc);
                    const double rx = std::sqrt(1 + x * x), ry = std::sqrt(1 + y * y);
                    const double parallel = 0.5 * (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry));
                    CHECK(factor({}, {0, 0, 1}, rectangle({0, 0, fc}, {fa, 0, 0}, {0, fb, 0})) ==
                          doctest::Approx(parallel).epsilon(1e-12));
                    // The wall is at x = c and has width b along y and height a along z.
                    const double h = std::sqrt(x * x + 1);
                    const double upright = 0.5 * (std::atan(y) - std::atan(y / h) / h);
                    CHECK(factor({}, {0, 0, 1}, rectangle({fc, 0, 0}, {0, fb, 0}, {0, 0, fa})) ==
                          doctest::Approx(upright).epsilon(1e-11));
                }
        // A unit square is above the point, centered at distance 1. It is four corner squares of side ½, so F =
        // 0.2395.
        CHECK(factor({}, {0, 0, 1}, rectangle({-0.5f, -0.5f, 1}, {1, 0, 0}, {0, 1, 0})) / kPiDouble ==
              doctest::Approx(0.23947).epsilon(1e-4));
    }

    TEST_CASE(
        "neither order nor starting vertex matters; pieces add up, also across the horizon; scale does not matter") {
        const Vec3 n = normalize(Vec3(0.3f, -0.1f, 1));
        const std::vector<Vec3> whole = rectangle({1, -1, -0.75f}, {0.5f, 2, 0}, {-0.25f, 0, 2});
        const double value = factor({}, n, whole);
        CHECK(value > 0.01);
        CHECK(factor({}, n, {whole[3], whole[2], whole[1], whole[0]}) == doctest::Approx(value).epsilon(1e-13));
        CHECK(factor({}, n, {whole[2], whole[3], whole[0], whole[1]}) == doctest::Approx(value).epsilon(1e-13));
        const Vec3 middle = whole[0] + Vec3(0.125f, 1, 1); // the parallelogram's center; all values are exact in binary
        double sum = 0;
        for (std::size_t i = 0; i < 4; ++i) sum += factor({}, n, {middle, whole[i], whole[(i + 1) % 4]});
        CHECK(sum == doctest::Approx(value).epsilon(1e-13));
        for (const int exponent : {-40, -20, 20, 40}) {
            std::vector<Vec3> scaled = whole;
            for (Vec3& v : scaled) v *= std::ldexp(1.0f, exponent);
            CHECK(factor({}, n, scaled) == value);
        }
    }

    TEST_CASE("far away the inverse-square law holds, near a large polygon the whole hemisphere") {
        for (const float d : {1e4f, 1e5f, 1e6f, 1e7f}) {
            const double exact = 1 / (static_cast<double>(d) * static_cast<double>(d));
            CHECK(factor({}, {0, 0, 1}, rectangle({-0.5f, -0.5f, d}, {1, 0, 0}, {0, 1, 0})) ==
                  doctest::Approx(exact).epsilon(1e-7));
            CHECK(factor({}, {0, 0, 1}, {{-0.5f, -0.5f, d}, {0.5f, -0.5f, d}, {0, 1, d}}) ==
                  doctest::Approx(0.75 * exact).epsilon(1e-7));
            CHECK(sphere_form_factor_times_pi({}, {0, 0.6f, 0.8f}, {{0, 0, d}, 2}) ==
                  doctest::Approx(4 * kPiDouble * 0.8 * exact).epsilon(1e-7));
        }
        // The near and far formulas must agree on both sides of the switch.
        const auto at = [&](float d) {
            return factor({0, 0, 0}, {0.6f, 0, 0.8f}, rectangle({0.2f * d, 0.1f * d, d}, {1, 0, 0.5f}, {0, 1, 0})) *
                   static_cast<double>(d) * static_cast<double>(d);
        };
        CHECK(at(1.05e5f) == doctest::Approx(at(1.3e5f)).epsilon(1e-5));
        for (const float gap : {1e-3f, 1e-6f, 1e-9f}) {
            const double value = factor({}, {0, 0, 1}, rectangle({-1000, -1000, gap}, {2000, 0, 0}, {0, 2000, 0}));
            CHECK(value <= kPiDouble);
            CHECK(value == doctest::Approx(kPiDouble).epsilon(2e-6));
        }
    }

    TEST_CASE("points in the polygon's plane, on its edges and vertices; vertices on the horizon; polygons below it") {
        const std::vector<Vec3> square = rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
        const Vec3 up{0, 0, 1}, side = normalize(Vec3(1, 0.5f, 0.2f));
        for (const Vec3 p :
             {Vec3(0.5f, 0.5f, 0), Vec3(0.5f, 0, 0), Vec3(0, 0, 0), Vec3(1, 1, 0), Vec3(5, 5, 0), Vec3(2, 0, 0)})
            for (const Vec3 n : {up, side, -up}) CHECK(factor(p, n, square) == 0);
        // The point is on the line of the edge, just above the plane. The result must be finite and within bounds;
        // the limit is half of the hemisphere's wedge.
        for (const float h : {1e-3f, 1e-6f, 1e-12f}) {
            const double value = factor({0.5f, 0, h}, {0, 0, -1}, square);
            CHECK(value == doctest::Approx(kPiDouble / 2).epsilon(3e-3));
        }
        // Two vertices are exactly on the horizon, or a whole edge is in the receiver's plane.
        CHECK(factor({}, up, {{1, -1, 0}, {1, 1, 0}, {1, 0, 1}}) > 0);
        const double above = factor({}, up, {{1, -1, 1e-7f}, {1, 1, 1e-7f}, {1, 0, 1}});
        CHECK(factor({}, up, {{1, -1, 0}, {1, 1, 0}, {1, 0, 1}}) == doctest::Approx(above).epsilon(1e-6));
        // The part below the horizon contributes nothing.
        const double cut = factor({}, up, {{1, -1, -3}, {1, 1, -3}, {1, 1, 2}, {1, -1, 2}});
        CHECK(cut == doctest::Approx(factor({}, up, {{1, -1, 0}, {1, 1, 0}, {1, 1, 2}, {1, -1, 2}})).epsilon(1e-13));
        CHECK(factor({}, up, {{1, -1, -3}, {1, 1, -3}, {1, 1, 0}, {1, -1, 0}}) == doctest::Approx(0));
        CHECK(factor({}, up, {{1, -1, -3}, {1, 1, -3}, {1, 1, -1}, {1, -1, -1}}) == 0);
        // Polygons without area or with too few vertices contribute nothing.
        CHECK(factor({}, up, {{1, 0, 1}, {1, 0, 1}, {1, 0, 1}}) == 0);
        CHECK(factor({}, up, {{1, 0, 1}, {1, 0, 2}}) == 0);
        // The triangle is a needle of width 1e-9.
        const double needle = factor({}, up, {{-1, 0, 1}, {1, 0, 1}, {1, 1e-9f, 1}, {-1, 1e-9f, 1}});
        // The exact value is ∫ w/(1 + x²)² dx over [−1, 1] = w·(½ + π/4).
        CHECK(needle == doctest::Approx(1e-9 * (0.5 + kPiDouble / 4)).epsilon(1e-6));
    }

    TEST_CASE("spheres: above, through and below the horizon, from grazing the surface to far away") {
        for (const double sine : {1e-3, 0.1, 0.5, 0.9, 0.999})
            for (const double share : {-1.1, -0.99, -0.5, 0.0, 0.5, 0.99, 1.0, 1.1}) { // cos θ in units of sin σ
                const double c = share * sine;
                if (std::abs(c) > 1) continue;
                const Sphere sphere{{static_cast<float>(std::sqrt(1 - c * c)), 0, static_cast<float>(c)},
                                    static_cast<float>(sine)};
                const double d = length(Vec3d(sphere.center)), z = static_cast<double>(sphere.center.z) / d;
                const double exact = sphere_by_quadrature(static_cast<double>(sphere.radius) / d, z);
                CAPTURE(sine);
                CAPTURE(share);
                CHECK(std::abs(sphere_form_factor_times_pi({}, {0, 0, 1}, sphere) - exact) < 5e-5 * sine * sine * sine);
            }
        // The two forms of the clipped case must agree: sin σ is just below and just above 1e-4.
        for (const double k : {-0.9, -0.3, 0.0, 0.4, 0.8}) {
            const auto at = [&](double sine) {
                const Sphere sphere{{1, 0, static_cast<float>(k * sine)}, static_cast<float>(sine)};
                return sphere_form_factor_times_pi({}, {0, 0, 1}, sphere) / (sine * sine * sine);
            };
            CHECK(at(0.99e-4) == doctest::Approx(at(1.01e-4)).epsilon(1e-5));
        }
        // On the surface the sphere covers half of the directions, so a tilted normal receives (1 + cos θ)/2 of π.
        // Inside, the sphere covers all directions.
        CHECK(sphere_form_factor_times_pi({}, {0, 0, 1}, {{0, 0, 1}, 0.99999f}) ==
              doctest::Approx(kPiDouble).epsilon(1e-4));
        CHECK(sphere_form_factor_times_pi({}, {0, 1, 0}, {{0, 0, 1}, 0.9999999f}) ==
              doctest::Approx(kPiDouble / 2).epsilon(1e-3));
        CHECK(sphere_form_factor_times_pi({}, {0, 1, 0}, {{0, 0, 1}, 2}) == kPiDouble);
        CHECK(sphere_form_factor_times_pi({}, {0, 0, -1}, {{0, 0, 5}, 1}) == 0);
        CHECK(sphere_form_factor_times_pi({}, {0, 0, 1}, {{0, 0, 5}, 0}) == 0);
    }
}
