// These tests check that baked transforms leave the visible surface unchanged, and which transforms are kept.
#include "tests/common/scene/one_object.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace duet;
using namespace duet::test;

namespace {

/// Checks that rays hit the same surface whether the object's transform is baked or not.
void check_same_surface(const Shape& shape, const Mat4d& transform, std::mt19937& random, bool with_uv) {
    Scene plain = scene_of(shape, transform);
    const Scene baked = finished(plain);
    REQUIRE(baked.objects[0].identity);
    std::uniform_real_distribution<float> u(-1, 1);
    int hits = 0;
    for (int i = 0; i < 300; ++i) {
        Ray ray{{10 * u(random), 10 * u(random), 10}, {}};
        const Vec3 local{0.25f + 0.3f * u(random), 0.25f + 0.3f * u(random), 0.25f + 0.3f * u(random)};
        ray.direction = normalize(transform_point(Mat4(transform), local) - ray.origin);
        const Hit a = nearest(plain, ray), b = nearest(baked, ray);
        if (a.valid() != b.valid() || a.primitive != b.primitive) continue; // rounding at an edge; counted below
        if (!a.valid()) continue;
        ++hits;
        const SurfacePoint p = surface_point(plain, ray, a), q = surface_point(baked, ray, b);
        CHECK(length(p.p - q.p) < 1e-3f); // rays start 20 units away, at any slant
        CHECK(dot(p.ng, q.ng) > 0.9999f);
        CHECK(dot(p.ns, q.ns) > 0.9999f);
        if (with_uv) CHECK(std::abs(p.uv.x - q.uv.x) + std::abs(p.uv.y - q.uv.y) < 1e-3f);
        CHECK(p.material == q.material);
    }
    CHECK(hits > 50);
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("Baked objects look as before, mirrored or not") {
        std::mt19937 random(3);
        Mesh smooth = tetrahedron();
        for (const Vec3 p : smooth.positions) {
            smooth.normals.push_back(normalize(p - Vec3(0.25f, 0.25f, 0.25f)));
            smooth.uvs.push_back({p.x + p.y, p.z - p.y});
        }
        for (int trial = 0; trial < 6; ++trial)
            for (const bool mirror : {false, true}) {
                CAPTURE(mirror);
                check_same_surface(tetrahedron(), random_transform(random, false, mirror), random, !mirror);
                check_same_surface(smooth, random_transform(random, true, mirror), random, true);
                check_same_surface(QuadList{{Quad{{0, 0, 0}, {1, 0, 0.3f}, {0, 1, 0.2f}}}},
                                   random_transform(random, false, mirror), random, !mirror);
                check_same_surface(Sphere{{0.25f, 0.25f, 0.25f}, 0.4f}, random_transform(random, true, mirror), random,
                                   false);
            }
    }

    TEST_CASE("What baking would change is left alone") {
        std::mt19937 random(4);
        const auto kept = [&](const Scene& scene) { return !finished(scene).objects[0].identity; };
        const Mat4d similar = random_transform(random, true, false), mirrored = random_transform(random, true, true),
                    skewed = random_transform(random, false, false);
        const Shape ball = Sphere{{0, 0, 0}, 1}, quad = QuadList{{Quad{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}},
                    mesh = tetrahedron();
        CHECK(kept(scene_of(ball, skewed)));
        CHECK_FALSE(kept(scene_of(mesh, skewed)));
        Mesh smooth = tetrahedron();
        smooth.normals.assign(4, Vec3(0, 0, 1));
        CHECK(kept(scene_of(smooth, skewed)));
        CHECK_FALSE(kept(scene_of(smooth, similar)));

        const auto textured = [](Scene scene, const Texture& texture) {
            scene.textures.textures = {texture};
            scene.textures.images = {ImageRgb(1, 1)};
            std::get<Diffuse>(scene.materials[0]).albedo.texture = 0;
            return scene;
        };
        for (const Shape& shape : {ball, quad, mesh}) {
            CHECK(kept(textured(scene_of(shape, similar), NoiseTexture{})));
            CHECK(kept(textured(scene_of(shape, similar), CheckerTexture{Rgb(), Rgb(), 1, true})));
            CHECK(kept(textured(scene_of(shape, mirrored), CheckerTexture{})));
            CHECK_FALSE(
                kept(textured(scene_of(shape, translation(Vec3d(1, 2, 3)) * scaling(Vec3d(2, 2, 2))), ImageTexture{})));
        }
        CHECK(kept(textured(scene_of(ball, similar), CheckerTexture{})));
        CHECK_FALSE(kept(textured(scene_of(quad, similar), CheckerTexture{})));

        Scene twice = scene_of(mesh, similar);
        twice.objects.push_back(placed(0, skewed, skewed));
        CHECK(kept(twice));
        Scene moving = scene_of(mesh, similar);
        moving.objects[0] = placed(0, similar, skewed);
        CHECK(kept(moving));
    }

    TEST_CASE("A box is baked only where its corners still meet, bit by bit") {
        std::mt19937 random(5);
        int baked = 0;
        for (int trial = 0; trial < 50; ++trial) {
            const Mat4d transform =
                trial == 0 ? translation(Vec3d(1, 2, 3)) : random_transform(random, false, trial % 2 == 1);
            const Scene scene = finished(scene_of(box_quads({-1, -1, -1}, {1, 1, 1}), transform));
            if (!scene.objects[0].identity) continue;
            ++baked;
            std::vector<std::array<float, 3>> distinct;
            for (std::uint32_t p = 0; p < 6; ++p) {
                const PrimitiveVertices c = primitive_vertices(scene.shapes[0], p);
                for (const Vec3 v : c.p) {
                    const std::array<float, 3> key{v.x, v.y, v.z};
                    if (std::find(distinct.begin(), distinct.end(), key) == distinct.end()) distinct.push_back(key);
                }
            }
            CHECK(distinct.size() == 8);
        }
        CHECK(baked >= 1);
    }

    TEST_CASE("Meshes are found closed, also after a mirroring bake") {
        CHECK(std::get<Mesh>(finished(scene_of(tetrahedron(), Mat4d())).shapes[0]).closed.value());
        CHECK(std::get<Mesh>(finished(scene_of(tetrahedron(), scaling(Vec3d(1, 1, -1)))).shapes[0]).closed.value());
        Mesh open = tetrahedron();
        open.triangles.pop_back();
        CHECK_FALSE(std::get<Mesh>(finished(scene_of(open, Mat4d())).shapes[0]).closed.value());
    }
}
