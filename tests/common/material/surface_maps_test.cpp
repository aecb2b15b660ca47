// These tests check normal maps, bump maps and opacity at a point.
#include "common/material/surface_maps.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

using namespace duet;

namespace {

/// Returns a point of a flat surface with normal z. u runs along x at two meters per unit, and v along y or opposite
/// to it.
SurfacePoint flat(float v_sign = 1) {
    SurfacePoint point;
    point.ng = point.ns = point.terminator_normal = {0, 0, 1};
    point.dpdu = {2, 0, 0};
    point.dpdv = {0, 2 * v_sign, 0};
    point.uv = {0.5f, 0.5f};
    return point;
}

constexpr Vec3 kFromAbove{0, 0, -1};

TextureSet plain(Rgb color) { return {{ImageTexture{0, {1, 1}, TextureFilter::kBilinear}}, {ImageRgb(1, 1, color)}}; }

SurfaceMaps with_normal(float scale = 1) {
    SurfaceMaps maps;
    maps.normal = 0;
    maps.normal_scale = scale;
    return maps;
}

bool near(Vec3 a, Vec3 b, float tolerance = 1e-5f) { return length(a - b) < tolerance; }

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("normal maps: components along u, v and the normal") {
        SurfacePoint point = flat();
        apply_normal_maps(plain({0.5f, 0.5f, 1}), with_normal(), kFromAbove, point);
        CHECK(near(point.ns, {0, 0, 1}));
        const Vec3 n = normalize(Vec3(0.3f, 0.2f, 0.9f));
        const Rgb color{(n.x + 1) / 2, (n.y + 1) / 2, (n.z + 1) / 2};
        point = flat();
        apply_normal_maps(plain(color), with_normal(), kFromAbove, point);
        CHECK(near(point.ns, n));
        point = flat(-1); // v runs downward, so the green channel flips, too
        apply_normal_maps(plain(color), with_normal(), kFromAbove, point);
        CHECK(near(point.ns, {n.x, -n.y, n.z}));
        point = flat();
        apply_normal_maps(plain(color), with_normal(0.5f), kFromAbove, point);
        CHECK(near(point.ns, normalize(Vec3(n.x / 2, n.y / 2, n.z))));
        point = flat();
        point.dpdu = point.dpdv = {}; // without tangents the normal is unchanged
        apply_normal_maps(plain(color), with_normal(), kFromAbove, point);
        CHECK(near(point.ns, {0, 0, 1}));
    }

    TEST_CASE("bump maps: the normal of the heights") {
        // A ramp in u has slope 1/2: it rises from 0 to 1 times half a meter over the 16 texels of 2 meters, measured
        // between texel centers.
        ImageRgb ramp(16, 1);
        for (int x = 0; x < 16; ++x) ramp(x, 0) = Rgb(static_cast<float>(x) / 16);
        const TextureSet set{{ImageTexture{0, {1, 1}, TextureFilter::kBilinear}}, {ramp}};
        SurfaceMaps maps;
        maps.bump = 0;
        maps.bump_scale = 0.5f;
        for (const float v_sign : {1.0f, -1.0f}) {
            SurfacePoint point = flat(v_sign);
            apply_normal_maps(set, maps, kFromAbove, point);
            CHECK(near(point.ns, normalize(Vec3(-0.25f, 0, 1))));
        }
        maps.bump_scale = -0.5f;
        SurfacePoint point = flat();
        apply_normal_maps(set, maps, kFromAbove, point);
        CHECK(near(point.ns, normalize(Vec3(0.25f, 0, 1))));
        // The surface must look the same from below.
        point = flat();
        apply_normal_maps(set, maps, -kFromAbove, point);
        CHECK(near(point.ns, normalize(Vec3(0.25f, 0, 1))));
    }

    TEST_CASE("bent normals leave the mirror direction above the surface, on either side, and lie on ng's") {
        std::mt19937 random(1);
        std::uniform_real_distribution<float> uniform(-1, 1);
        int bent = 0;
        for (int i = 0; i < 20000; ++i) {
            const Vec3 n = normalize(Vec3(uniform(random), uniform(random), std::abs(uniform(random)) + 1e-3f));
            const Vec3 direction = normalize(Vec3(uniform(random), uniform(random), uniform(random)));
            if (std::abs(direction.z) < 0.02f) continue;
            SurfacePoint point = flat();
            apply_normal_maps(plain({(n.x + 1) / 2, (n.y + 1) / 2, (n.z + 1) / 2}), with_normal(), direction, point);
            REQUIRE(length(point.ns) == doctest::Approx(1));
            REQUIRE(dot(point.ns, point.ng) > 0);
            bent += !near(point.ns, n, 1e-3f);
            const float side = direction.z > 0 ? -1.0f : 1.0f;
            const Vec3 mirrored = reflect(-direction, point.ns * side);
            REQUIRE(mirrored.z * side > 0);
        }
        CHECK(bent > 1000); // otherwise the test covers nothing
    }

    TEST_CASE("near silhouettes, where smooth normals lean away from the viewer, an even map changes nothing, another "
              "little") {
        const Vec3 to_viewer = normalize(Vec3(1, 0, 0.03f));
        const auto bent = [&](Vec3 smooth, Rgb color) {
            SurfacePoint point = flat();
            point.ns = point.terminator_normal = smooth;
            apply_normal_maps(plain(color), with_normal(), -to_viewer, point);
            return point.ns;
        };
        for (int degrees = 0; degrees <= 20; ++degrees) {
            const float lean = static_cast<float>(degrees) * 3.14159265f / 180;
            const Vec3 smooth{-std::sin(lean), 0, std::cos(lean)};
            CAPTURE(degrees);
            CHECK(near(bent(smooth, {0.5f, 0.5f, 1}), smooth, 0.01f));
            CHECK(dot(bent(smooth, {0.5f, 0.65f, 0.95f}), smooth) > 0.9f); // at most 18° toward y
        }
    }

    TEST_CASE("opacity: number, texture, cutoff") {
        SurfaceMaps maps;
        CHECK_FALSE(maps.has_transparency());
        maps.opacity = {0.8f, 0};
        CHECK(maps.has_transparency());
        CHECK(opacity(plain(Rgb(0.5f)), maps, flat()) == doctest::Approx(0.4f));
        maps.cutoff = 0.4f;
        CHECK(opacity(plain(Rgb(0.5f)), maps, flat()) == 1);
        maps.cutoff = 0.41f;
        CHECK(opacity(plain(Rgb(0.5f)), maps, flat()) == 0);
        maps = {};
        maps.opacity = 0.25f;
        CHECK(opacity({}, maps, flat()) == 0.25f);
    }
}
