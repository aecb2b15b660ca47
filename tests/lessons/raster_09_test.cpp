// Lesson raster-09 and the library: the same depths in the map, and the same shadows away from their edges.
#include "raster/lessons/09-shadow-maps/shadow.h"
#include "raster/shadows/pcf.h"
#include "tests/raster/shadow_floor.h"

#include <doctest/doctest.h>

#include <random>

using namespace duet;

namespace {

constexpr int kMapSide = 256;
constexpr float kRadius = 2;

/// A ring above a floor, for both.
struct RingScene {
    Scene library = test::floor_scene();
    lesson::Mesh world;

    RingScene() {
        const auto add = [this](Vec3 a, Vec3 b, Vec3 c) {
            const Vec3 n = normalize(cross(b - a, c - a));
            for (const Vec3 p : {a, b, c}) world.push_back({p, n, {}});
        };
        add({-4, 0, 4}, {4, 0, 4}, {4, 0, -4}), add({-4, 0, 4}, {4, 0, -4}, {-4, 0, -4});
        Mesh ring = test::torus(24, 12);
        for (Vec3& p : ring.positions) p = p * 0.7f + Vec3{0, 0.9f, 0};
        for (const auto& t : ring.triangles) add(ring.positions[t[0]], ring.positions[t[1]], ring.positions[t[2]]);
        test::add(library, ring);
        finish_scene(library);
    }
};

/// Whether a ray from p meets the scene: Möller and Trumbore's test of all triangles, in double.
bool is_blocked(const lesson::Mesh& world, Vec3d p, Vec3d d) {
    for (std::size_t i = 0; i < world.size(); i += 3) {
        const Vec3d a(world[i].p), u = Vec3d(world[i + 1].p) - a, v = Vec3d(world[i + 2].p) - a, o = p - a;
        const Vec3d normal = cross(d, v), across = cross(o, u);
        const double det = dot(u, normal), b = dot(o, normal) / det, c = dot(d, across) / det;
        if (b >= 0 && c >= 0 && b + c <= 1 && dot(v, across) / det > 1e-6) return true;
    }
    return false;
}

} // namespace

TEST_SUITE("lesson") {

    TEST_CASE("raster-09: the library's shadow map has the lesson's depths, and both agree with rays off the edges") {
        const RingScene scene;
        const raster::RasterScene prepared = raster::prepare(scene.library, {});
        for (const Vec3 direction : {Vec3{0.62f, 0.42f, 0.55f}, Vec3{0, 1, 0}, Vec3{-0.3f, 0.8f, -0.9f}}) {
            const Vec3 to_sun = normalize(direction), center{0, 0.5f, 0};
            const Mat4 matrix = lesson::sun_matrix(to_sun, center, kRadius);
            const lesson::ShadowMap map = lesson::draw_shadow_map(scene.world, matrix, 2 * kRadius, kMapSide);
            Camera camera;
            camera.projection = Camera::Projection::kOrthographic;
            camera.eye = Vec3d(center + to_sun * kRadius), camera.look_at = Vec3d(center);
            if (to_sun.y > 0.9f) camera.up = {0, 0, 1};
            camera.height = 2 * static_cast<double>(kRadius), camera.near = 1e-3;
            const raster::ShadowMap library(prepared.data(), camera, kMapSide, 1, kNoObject);
            // The lesson's depths are those of triangles with snapped corners: off by up to √2/512 texel times the
            // slope. Facets steeper than 20 are as rare as the texels that the two cameras' roundings decide.
            const double texel = 2 * static_cast<double>(kRadius) / kMapSide,
                         bound = 20 * std::sqrt(2.0) / 512 * texel + 1e-5;
            int different = 0, seen = 0;
            for (int y = 0; y < kMapSide; ++y)
                for (int x = 0; x < kMapSide; ++x) {
                    const double reversed_depth = static_cast<double>(library.reversed_depth()(x, y));
                    const double d = static_cast<double>(map.depth(x, y)) * map.size;
                    const bool nothing = reversed_depth == 0 || !(d > 1e-3);
                    if (nothing && std::isinf(map.depth(x, y)) && reversed_depth == 0) continue;
                    ++seen;
                    different += nothing || std::abs(camera.near / reversed_depth - d) > bound;
                }
            CHECK(seen > kMapSide * kMapSide / 2);
            CHECK(different < seen / 500);

            // Points of the floor: where all texels within three of the point agree, so do both shadows and the ray.
            std::mt19937 random(9);
            std::uniform_real_distribution<double> place(-1.2, 1.2);
            const raster::SharpShadowMap lookup(library, {});
            int dark = 0, lit = 0;
            for (int i = 0; i < 3000; ++i) {
                const double px = place(random);
                const Vec3d p(px, 0, place(random));
                const float fraction =
                    lesson::lit_fraction(map, Vec3(p), lesson::slope_bias(map, to_sun, {0, 1, 0}, 3), 3);
                if (fraction > 0 && fraction < 1) continue;
                const auto lanes = [](Vec3 v) { return broadcast<raster::Floats>(v); };
                xsimd::batch_bool<float> inside;
                const auto found = lookup.visibility(lanes(Vec3(p)), lanes({0, 1, 0}), inside);
                REQUIRE(xsimd::all(inside));
                REQUIRE(found.get(0) == doctest::Approx(fraction));
                REQUIRE(is_blocked(scene.world, p, Vec3d(to_sun)) == (fraction == 0));
                (fraction == 0 ? dark : lit)++;
            }
            CHECK(dark > 100);
            CHECK(lit > 500);
        }
    }

    TEST_CASE("raster-09: no plane shades itself with the bias from the slope, and many would without") {
        std::mt19937 random(19);
        const auto uniform = [&](float low, float high) { return std::uniform_real_distribution(low, high)(random); };
        int points = 0, acne = 0;
        for (int i = 0; i < 60; ++i) {
            Vec3 to_sun, n;
            do {
                to_sun = Vec3{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
                n = Vec3{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
            } while (length(to_sun) > 1 || length(n) > 1 || dot(normalize(n), normalize(to_sun)) < 0.12f);
            to_sun = normalize(to_sun), n = normalize(n);
            const Vec3 u = normalize(cross(n, std::abs(n.x) < 0.8f ? Vec3{1, 0, 0} : Vec3{0, 1, 0})), v = cross(n, u);
            lesson::Mesh plane;
            for (const Vec2 q : {Vec2{-3, -3}, {3, -3}, {3, 3}, {-3, -3}, {3, 3}, {-3, 3}})
                plane.push_back({u * q.x + v * q.y, n, {}});
            const auto map = lesson::draw_shadow_map(plane, lesson::sun_matrix(to_sun, {}, 2), 4, 32 << i % 5);
            for (int k = 0; k < 200; ++k) {
                const float a = uniform(-1, 1);
                const Vec3 p = u * a + v * uniform(-1, 1);
                for (const int reach : {0, 2})
                    REQUIRE(lesson::lit_fraction(map, p, lesson::slope_bias(map, to_sun, n, reach), reach) == 1);
                acne += lesson::lit_fraction(map, p, 0, 0) == 0, ++points;
            }
        }
        CHECK(acne > points / 4);
    }
}
