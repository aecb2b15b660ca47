// These tests check the lights that finish_scene() makes of emissive surfaces: their side, order and index.
#include "tests/common/scene/one_object.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::test;

namespace {

const SurfaceLight& only_light(const Scene& scene) {
    REQUIRE(scene.lights.size() == 1);
    REQUIRE(scene.first_surface_light == 0);
    return std::get<SurfaceLight>(scene.lights[0]);
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("A mirrored light shines on the mirror image of its front side") {
        // In object space the front side is +z. The transform (x, y, −z) makes it −z, and (−x, y, z) leaves it at +z.
        const Emissive area_light{Rgb(2.0f)};
        Mesh triangle;
        triangle.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        triangle.triangles = {{0, 1, 2}};
        const Shape shapes[] = {QuadList{{Quad{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}}, triangle};
        for (const Shape& shape : shapes)
            for (const bool baked : {true, false}) {
                CAPTURE(baked);
                for (const auto& [stretch, side_of_front] :
                     {std::pair(Vec3d(1, 1, 1), 1.0f), std::pair(Vec3d(1, 1, -1), -1.0f),
                      std::pair(Vec3d(-1, 1, 1), 1.0f)}) {
                    const Vec3d scale = stretch;
                    const float front = side_of_front;
                    Scene scene = scene_of(shape, scaling(scale), area_light);
                    if (!baked)
                        scene.objects.push_back(
                            // This object moves, so it is not a light.
                            placed(0, translation(Vec3d(5, 0, 0)), translation(Vec3d(5, 1, 0))));
                    finish_scene(scene);
                    const SurfaceLight& light = only_light(scene);
                    const float x = 0.25f * static_cast<float>(scale.x);
                    CHECK(emits_towards(light, {x, 0.25f, front}));
                    CHECK_FALSE(emits_towards(light, {x, 0.25f, -front}));
                    // The side that a ray hits must agree.
                    for (const float side : {-1.0f, 1.0f}) {
                        const Ray ray{{x, 0.25f, side}, {0, 0, -side}};
                        const SurfacePoint point = surface_point(scene, ray, nearest(scene, ray));
                        CHECK(is_black(emitted(scene.materials[0], scene.textures, point, -ray.direction)) ==
                              (side != front));
                    }
                }
            }
    }

    TEST_CASE("Spheres emit outwards under any similarity; as ellipsoids they are no light") {
        const Emissive area_light{Rgb(2.0f)};
        const Scene mirrored = finished(scene_of(Sphere{{1, 0, 0}, 0.5f}, scaling(Vec3d(-2, 2, 2)), area_light));
        const SurfaceLight& light = only_light(mirrored);
        CHECK(std::get<Sphere>(light.shape).center == Vec3(-2, 0, 0));
        CHECK(std::get<Sphere>(light.shape).radius == 1);
        CHECK(emits_towards(light, {5, 0, 0}));
        CHECK(finished(scene_of(Sphere{{1, 0, 0}, 0.5f}, scaling(Vec3d(1, 2, 1)), area_light)).lights.empty());
    }

    TEST_CASE("Surface lights follow the described ones, sorted, and are found again") {
        Scene scene;
        scene.materials = {Diffuse{}, Emissive{Rgb(3.0f)}, Emissive{Rgb(0.0f)}};
        scene.material_names = {"white", "lamp", "off"};
        Mesh mesh = tetrahedron();
        mesh.positions.push_back({2, 2, 2});
        mesh.triangles.push_back({4, 4, 4}); // zero area
        mesh.material_slots = {1, 0, 1, 2, 1};
        scene.shapes = {mesh, box_quads({0, 0, 0}, {1, 1, 1}), Sphere{}};
        scene.objects = {placed(0, translation(Vec3d(4, 0, 0)), translation(Vec3d(4, 0, 0))),
                         placed(1, Mat4d(), Mat4d()), placed(2, Mat4d(), translation(Vec3d(0, 1, 0)))};
        scene.objects[0].materials = {0, 1, 2};
        scene.objects[1].materials = {1};
        scene.objects[2].materials = {1};
        scene.lights = {PointLight{{0, 5, 0}, Rgb(1.0f)}};
        for (int repeat = 0; repeat < 2; ++repeat) { // a second call changes nothing
            finish_scene(scene);
            CHECK(scene.first_surface_light == 1);
            REQUIRE(scene.lights.size() == 1 + 2 + 6);
        }
        for (std::uint32_t o = 0; o < 3; ++o)
            for (std::uint32_t p = 0; p < primitive_count(scene.shapes[o]); ++p) {
                const std::int64_t index = surface_light_index(scene, o, p);
                const bool expected = (o == 0 && (p == 0 || p == 2)) || o == 1;
                CHECK((index >= 0) == expected);
                if (index < 0) continue;
                const auto& light = std::get<SurfaceLight>(scene.lights[static_cast<std::size_t>(index)]);
                CHECK(light.object == o);
                CHECK(light.primitive == p);
            }
        CHECK(material_index(scene, 0, 3) == 2);
        CHECK(scene.needs.delta_lights);
        CHECK(scene.needs.surface_lights);
        CHECK(scene.needs.motion);
        CHECK(scene.needs.meshes);
        CHECK(scene.needs.quads);
        CHECK(scene.needs.spheres);
        CHECK_FALSE(scene.needs.textures);
        CHECK_FALSE(scene.needs.environment);
    }
}
