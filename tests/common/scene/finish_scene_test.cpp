// These tests check what finish_scene() refuses, and the bounds and the needs that it finds.
#include "tests/common/scene/one_object.h"
#include "tests/support/errors.h"

#include <doctest/doctest.h>

#include <functional>
#include <limits>

using namespace duet;
using namespace duet::test;

TEST_SUITE("unit") {

    TEST_CASE("a scene in code whose parts do not fit together is refused, and the message names the part") {
        const auto ring = [] {
            Scene scene;
            const std::uint32_t gray = add_material(scene, "gray", Diffuse{});
            add_object(scene, "patch", Mesh{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}}},
                       gray, Mat4(translation(Vec3(1, 2, 3))));
            return scene;
        };
        const auto error_after = [&](const std::function<void(Scene&)>& change) {
            Scene scene = ring();
            change(scene);
            return error_of([&] { finish_scene(scene); });
        };
        const auto mesh = [](Scene& scene) -> Mesh& { return std::get<Mesh>(scene.shapes.edit(0)); };
        constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
        const std::vector<std::pair<std::function<void(Scene&)>, const char*>> cases{
            {[](Scene&) {}, "no error"},
            {[](Scene& s) { s.material_names.clear(); }, "found 0 material names, expected 1"},
            {[](Scene& s) { s.objects[0].shape = 1; }, "the shape of the object patch: found the index 1, expected"},
            {[](Scene& s) { s.objects[0].materials = {3}; }, "a material of the object patch: found the index 3"},
            {[](Scene& s) { s.objects[0].materials.clear(); }, "\"patch\": found 0 materials, expected at least 1"},
            {[](Scene& s) { s.objects[0].identity = true; }, "\"patch\": Object::place() was not called"},
            {[](Scene& s) { s.objects[0].moving = true; }, "\"patch\": Object::place() was not called"},
            {[](Scene& s) { std::get<Diffuse>(s.materials[0]).albedo.texture = 0; },
             "a texture of the material \"gray\": found the index 0, expected one below 0"},
            {[&](Scene& s) { mesh(s).triangles[0][2] = 3; }, "found the vertex 3 in triangle 0, expected one below 3"},
            {[&](Scene& s) { mesh(s).positions[1].y = kNan; }, "the vertex 1 is not finite"},
            {[&](Scene& s) { mesh(s).normals.resize(2); }, "found 2 normals, expected 0 or 3"},
            {[&](Scene& s) { mesh(s).uvs.resize(4); }, "found 4 texture coordinates, expected 0 or 3"},
            {[&](Scene& s) { mesh(s).material_slots = {1}; }, "\"patch\": found 1 materials, expected at least 2"},
            {[](Scene& s) { s.camera.look_at = s.camera.eye; }, "look_at must not be where its eye is"},
            {[](Scene& s) { s.lights = {SunLight{{0, -2, 0}, Rgb(1.0f)}}; }, "a sun's direction has the length 2"},
            {[](Scene& s) { s.lights = {SpotLight{{}, {0, -1, 0}, Rgb(1.0f), 0.5f, 0.6f}}; },
             "a spot light's cos_inner must be above its cos_outer"},
            {[](Scene& s) { s.shapes.edit(0) = Sphere{{}, 0}; }, "\"patch\": found the radius 0, expected one above 0"},
        };
        for (const auto& [change, expected] : cases) CHECK(says(error_after(change), expected));
    }

    TEST_CASE("Bounds hold every moment of the motion") {
        std::mt19937 random(6);
        std::uniform_real_distribution<float> u(-1, 1);
        for (int trial = 0; trial < 20; ++trial) {
            Scene scene = scene_of(tetrahedron(), Mat4d());
            const Mat4d start = random_transform(random, false, false);
            scene.objects[0] = placed(0, start, translation(Vec3d(3, -2, 1)) * rotation(Vec3d(0, 1, 0), 1.0) * start);
            scene.shapes.push_back(Sphere{{0.5f, 0, 0}, 0.75f});
            scene.objects.push_back(placed(1, Mat4d(scene.objects[0].to_world), Mat4d(scene.objects[0].to_world_end)));
            finish_scene(scene);
            for (const float time : {0.0f, 0.25f, 0.5f, 0.9f, 1.0f}) {
                const Mat4 m = object_transform(scene.objects[0], time).to_world;
                for (const Vec3 p : tetrahedron().positions) CHECK(scene.bounds.contains(transform_point(m, p)));
                for (int i = 0; i < 20; ++i)
                    CHECK(scene.bounds.contains(transform_point(
                        m, Vec3(0.5f, 0, 0) + normalize(Vec3{u(random), u(random), u(random) + 1e-3f}) * 0.75f)));
            }
        }
    }

    TEST_CASE("Needs count only what is used") {
        Scene scene = scene_of(tetrahedron(), Mat4d());
        scene.materials = {Diffuse{}, Dielectric{}, Metal{{Rgb(1.0f)}, 0.009f}, Metal{{Rgb(1.0f)}, 0.011f}};
        scene.material_names = {"a", "b", "c", "d"};
        const auto needs = [&](std::uint32_t material) {
            scene.objects[0].materials = {material};
            return finished(scene).needs;
        };
        CHECK_FALSE(needs(0).specular);
        CHECK_FALSE(needs(0).glossy);
        CHECK(needs(1).transmission);
        CHECK(needs(1).specular);
        CHECK(needs(2).specular);
        CHECK_FALSE(needs(2).glossy);
        CHECK(needs(3).glossy);
        CHECK_FALSE(needs(3).specular);
        CHECK_FALSE(needs(0).smooth_normals);
        scene.environment = SkyEnvironment{};
        CHECK(needs(0).environment);
    }

    TEST_CASE("Lights that emit nothing and masks that hide nothing are dropped") {
        Scene scene = scene_of(Sphere{}, Mat4d());
        scene.lights = {PointLight{{0, 2, 0}, Rgb(0.0f)}, SunLight{{0, -1, 0}, Rgb(0, 0.1f, 0)},
                        SunLight{{0, -1, 0}, Rgb(0.0f)}, SpotLight{{0, 2, 0}, {0, -1, 0}, Rgb(0.0f)}};
        const Scene lit = finished(scene);
        REQUIRE(lit.lights.size() == 1);
        CHECK(std::get<SunLight>(lit.lights[0]).irradiance == Rgb(0, 0.1f, 0));

        ImageRgb image(2, 1);
        image[0] = Rgb(1, 0, 0), image[1] = Rgb(1, 1, 1);
        scene.textures.images = {image};
        scene.textures.textures = {CheckerTexture{Rgb(1, 0, 0), Rgb(1, 1, 1)}, CheckerTexture{Rgb(1, 0, 0), Rgb(0.5f)},
                                   NoiseTexture{Rgb(0.5f), Rgb(0.5f)}, ImageTexture{}};
        const auto opacity = [&](ScalarSlot slot) {
            scene.maps = {SurfaceMaps{}};
            scene.maps[0].opacity = slot;
            return finished(scene);
        };
        CHECK_FALSE(opacity({1, 0}).needs.alpha);
        CHECK(opacity({1, 1}).needs.alpha);
        CHECK(opacity({1, 1}).maps[0].opacity.texture == 1);
        const Scene half = opacity({1, 2});
        CHECK(half.needs.alpha);
        CHECK(half.maps[0].opacity.constant());
        CHECK(half.maps[0].opacity.value == 0.5f);
        CHECK(opacity({0.25f, 0}).maps[0].opacity.value == 0.25f);
        CHECK_FALSE(opacity({1, 3}).needs.alpha);
        scene.textures.images.edit(0)[1].r = 0.99f;
        CHECK(opacity({1, 3}).needs.alpha);
    }

    TEST_CASE("An empty scene has finite bounds; one that reaches too far is refused") {
        Scene empty;
        finish_scene(empty);
        CHECK(is_finite(empty.bounds.low));
        CHECK_FALSE(empty.bounds.empty());
        const auto error = error_of([] {
            finished(scene_of(Sphere{{0, 0, 0}, 1e15f}, scaling(Vec3d(1e5, 1e5, 1e5))));
        });
        CHECK_MESSAGE(says(error, "the object \"object 0\" reaches beyond 1e18"), error);
        const auto power = error_of([] {
            finished(scene_of(Sphere{{0, 0, 0}, 1e17f}, Mat4d(), Emissive{Rgb(1e12f)}));
        });
        CHECK_MESSAGE(says(power, "a light's power is beyond"), power);
    }
}
