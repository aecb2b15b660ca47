// Makes scenes of one object for tests of finish_scene().
#pragma once

#include "common/geometry/quad.h"
#include "common/geometry/sphere.h"
#include "common/geometry/triangle.h"
#include "common/scene/build_scene.h"

#include <optional>
#include <random>

namespace duet::test {

/// Returns an object with a shape and the first material, which moves between two transforms.
inline Object placed(std::uint32_t shape, const Mat4d& to_world, const Mat4d& end) {
    Object object;
    object.name = message("object ", shape);
    object.shape = shape;
    object.materials = {0};
    object.place(Mat4(to_world), Mat4(end));
    return object;
}

/// Returns a scene of one object, without its derived data.
inline Scene scene_of(const Shape& shape, const Mat4d& to_world, const Material& material = Diffuse{}) {
    Scene scene;
    scene.materials = {material};
    scene.material_names = {"m"};
    scene.shapes = {shape};
    scene.objects = {placed(0, to_world, to_world)};
    return scene;
}

/// Returns the scene with its derived data.
inline Scene finished(Scene scene) {
    finish_scene(scene);
    return scene;
}

/// Returns a closed mesh.
inline Mesh tetrahedron() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    return mesh;
}

/// Returns the nearest hit of a ray with one object by testing all of its primitives.
inline Hit nearest(const Scene& scene, const Ray& world) {
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

/// Returns a random transform. A similarity scales all axes alike.
inline Mat4d random_transform(std::mt19937& random, bool similarity, bool mirror) {
    std::uniform_real_distribution<double> u(-1, 1);
    const Vec3d axis = normalize(Vec3d{u(random), u(random), u(random) + 2});
    const double s = 1.5 + u(random);
    const Vec3d scale = similarity ? Vec3d(s, s, s) : Vec3d(s, s * 1.5, s * 0.7);
    return translation(Vec3d{u(random), u(random), u(random)}) * rotation(axis, 3 * u(random)) *
           scaling(mirror ? Vec3d(-scale.x, scale.y, scale.z) : scale);
}

} // namespace duet::test
