// Lesson raster-06: normals of placed meshes are those of the library's surface points, and light falls alike.
#include "common/geometry/surface_point.h"
#include "raster/lessons/06-shading/shading.h"
#include "raster/shading/phong_model.h"

#include <doctest/doctest.h>

#include <random>

using namespace duet;

namespace {

struct Random {
    std::mt19937 bits;
    float uniform(float low, float high) { return std::uniform_real_distribution<float>(low, high)(bits); }
    Vec3 point(float size) {
        const float x = uniform(-size, size), y = uniform(-size, size);
        return {x, y, uniform(-size, size)};
    }
    Vec3 unit() {
        for (;;)
            if (const Vec3 v = point(1); length(v) > 0.1f && length(v) < 1) return normalize(v);
    }
};

} // namespace

TEST_SUITE("lesson") {

    TEST_CASE("raster-06: normals of a placed triangle are the library's, flat and interpolated") {
        Random random{std::mt19937(6)};
        int cases = 0, mirrored = 0, compared = 0;
        while (cases < 2000) {
            Mat4 m = translation(random.point(5));
            for (std::size_t r = 0; r < 3; ++r)
                for (std::size_t c = 0; c < 3; ++c) m[r][c] = random.uniform(-2, 2);
            if (std::abs(determinant3(m)) < 0.5f) continue;
            const Vec3 a = random.point(1), b = random.point(1), c = random.point(1), face = cross(b - a, c - a);
            if (length(face) < 0.1f) continue;
            const Vec3 ng = normalize(face);
            const auto near = [&] { return normalize(ng + random.unit() * 0.5f); };
            const lesson::Mesh naive{{a, near(), {}}, {b, near(), {}}, {c, near(), {}}};
            const lesson::Triangle t = lesson::place_mesh(naive, m, Mat4())[0];
            const Mesh mesh{.positions = {a, b, c},
                            .normals = {naive[0].n, naive[1].n, naive[2].n},
                            .uvs = {},
                            .triangles = {{0, 1, 2}},
                            .material_slots = {}};
            const auto library = [&](float u, float v) {
                Hit hit;
                hit.object = hit.primitive = 0, hit.u = u, hit.v = v, hit.t = 1;
                return surface_point(mesh, hit, Ray{{0, 0, 0}, {0, 0, -1}}, m, inverse_affine(m), false);
            };
            // At corners the two are the same normal, scaled. Between them the lesson mixes unit vectors, the library
            // the ones before the map, so it is compared at the corners.
            const std::array<Vec2, 3> corners{Vec2{0, 0}, Vec2{1, 0}, Vec2{0, 1}};
            for (std::size_t k = 0; k < 3; ++k) {
                const SurfacePoint at = library(corners[k].x, corners[k].y);
                REQUIRE(length(at.p - t[k].p) < 1e-5f);
                if (dot(t[k].n, at.ng) < 0.05f) continue; // the library turns normals that look inward
                REQUIRE(length(at.ns - t[k].n) < 1e-4f);
                ++compared;
            }
            // A map that mirrors turns the corners around; the library's normal stays outside.
            const float side = determinant3(m) < 0 ? -1.0f : 1.0f;
            const Vec3 flat = normalize(cross(t[1].p - t[0].p, t[2].p - t[0].p)) * side;
            REQUIRE(length(library(0.3f, 0.3f).ng - flat) < 1e-3f);
            ++cases, mirrored += side < 0;
        }
        CHECK(mirrored > 500);
        CHECK(compared > 5000);
    }

    TEST_CASE("raster-06: the library's diffuse light is the lesson's, and highlights have the same middle") {
        Random random{std::mt19937(66)};
        int lit = 0;
        for (int i = 0; i < 5000; ++i) {
            const Vec3 n = random.unit(), l = random.unit(), e = random.unit();
            const raster::PhongFactors<float> factors({n, 1}, {e, 1}, l);
            const Rgb diffuse = lesson::blinn_phong(n, l, e, {Rgb(0.5f, 0.25f, 1), 0, 60});
            REQUIRE(std::abs(diffuse.b - factors.cosine) < 1e-6f);
            if (factors.cosine < 0.01f) continue;
            ++lit;
            const Vec3 mirror = reflect(l, n);
            const raster::PhongFactors<float> middle({n, 1}, {mirror, 1}, l);
            const float naive = lesson::blinn_phong(n, l, mirror, {Rgb(0), 1, 60}).r;
            REQUIRE(std::abs(naive - 1) < 1e-4f);
            REQUIRE(std::abs(middle.lobe - 1) < 1e-4f);
            // Phong's angle is at most twice Blinn's, and just that where all lie in one plane.
            const float half = lesson::blinn_phong(n, l, e, {Rgb(0), 1, 1}).r;
            REQUIRE(dot(mirror, e) > 2 * half * half - 1 - 1e-4f);
        }
        CHECK(lit > 2000);
    }
}
