// These tests check what finish_scene computes: baked transforms that leave the visible surface unchanged, lights on
// the correct side, bounds, and required features.
#include "common/scene/build_scene.h"

#include "common/geometry/quad.h"
#include "common/geometry/sphere.h"
#include "common/geometry/triangle.h"
#include "tests/support/errors.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <random>

using namespace duet;
using duet::test::error_of;
using duet::test::says;

namespace {

Object placed(std::uint32_t shape, const Mat4d& to_world, const Mat4d& end) {
    Object object;
    object.name = message("object ", shape);
    object.shape = shape;
    object.materials = {0};
    object.place(Mat4(to_world), Mat4(end));
    return object;
}

Scene scene_of(const Shape& shape, const Mat4d& to_world, const Material& material = Diffuse{}) {
    Scene scene;
    scene.materials = {material};
    scene.material_names = {"m"};
    scene.shapes = {shape};
    scene.objects = {placed(0, to_world, to_world)};
    return scene;
}

Scene finished(Scene scene) {
    finish_scene(scene);
    return scene;
}

Mesh tetrahedron() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    return mesh;
}

/// Returns the nearest hit of a ray with one object by testing all of its primitives.
Hit nearest(const Scene& scene, const Ray& world) {
    const Object& object = scene.objects[0];
    const ObjectTransform transform = object_transform(object, world.time);
    Ray ray = world;
    if (!object.identity) ray = to_object_space(world, transform.to_world, transform.to_object);
    const Shape& shape = scene.shapes[object.shape];
    Hit best;
    for (std::uint32_t p = 0; p < primitive_count(shape); ++p) {
        std::optional<TriangleHit> hit;
        if (const auto* sphere = std::get_if<Sphere>(&shape)) {
            if (const auto t = intersect_sphere(ray, *sphere)) hit = TriangleHit{*t, 0, 0};
        } else if (const auto* list = std::get_if<QuadList>(&shape)) {
            hit = intersect_quad(ShearedRay(ray), list->quads[p]);
        } else {
            const PrimitiveVertices c = primitive_vertices(shape, p);
            hit = intersect_triangle(ShearedRay(ray), c.p[0], c.p[1], c.p[2]);
        }
        if (hit && hit->t < best.t) best = {0, p, hit->u, hit->v, hit->t};
    }
    return best;
}

Mat4d random_transform(std::mt19937& random, bool similarity, bool mirror) {
    std::uniform_real_distribution<double> u(-1, 1);
    const Vec3d axis = normalize(Vec3d{u(random), u(random), u(random) + 2});
    const double s = 1.5 + u(random);
    const Vec3d scale = similarity ? Vec3d(s, s, s) : Vec3d(s, s * 1.5, s * 0.7);
    return translation(Vec3d{u(random), u(random), u(random)}) * rotation(axis, 3 * u(random)) *
           scaling(mirror ? Vec3d(-scale.x, scale.y, scale.z) : scale);
}

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

const SurfaceLight& only_light(const Scene& scene) {
    REQUIRE(scene.lights.size() == 1);
    REQUIRE(scene.first_surface_light == 0);
    return std::get<SurfaceLight>(scene.lights[0]);
}

} // namespace

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
        scene.textures.images[0][1].r = 0.99f;
        CHECK(opacity({1, 3}).needs.alpha);
    }

    TEST_CASE("Meshes are found closed, also after a mirroring bake") {
        CHECK(std::get<Mesh>(finished(scene_of(tetrahedron(), Mat4d())).shapes[0]).closed.value());
        CHECK(std::get<Mesh>(finished(scene_of(tetrahedron(), scaling(Vec3d(1, 1, -1)))).shapes[0]).closed.value());
        Mesh open = tetrahedron();
        open.triangles.pop_back();
        CHECK_FALSE(std::get<Mesh>(finished(scene_of(open, Mat4d())).shapes[0]).closed.value());
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

} // TEST_SUITE
