// These tests check the sampling of triangles and quads, near and far and at any slant.
#include "common/light/light.h"
#include "common/light/solid_angle.h"
#include "common/sampling/hash.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace duet;

namespace {

/// Returns number i of a fixed random stream, in [0, 1).
double number(std::uint64_t i) { return static_cast<double>(unit_float(high_bits(stream_number(99, i)))); }
Vec3d vector(std::uint64_t i) { return {2 * number(3 * i) - 1, 2 * number(3 * i + 1) - 1, 2 * number(3 * i + 2) - 1}; }

} // namespace

TEST_SUITE("unit") {
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
