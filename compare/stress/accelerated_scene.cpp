#include "compare/stress/accelerated_scene.h"

#include "common/geometry/quad.h"
#include "common/geometry/sphere.h"
#include "common/sampling/hash.h"
#include "raytrace/acceleration/bvh_traverse.h"

#include <map>

namespace duet::compare {

namespace {

Scene finished(std::vector<Shape> shapes, std::vector<Object> objects) {
    Scene scene;
    scene.materials = {Diffuse{}};
    scene.material_names = {"grey"};
    scene.shapes = SharedList<Shape>(std::move(shapes));
    scene.objects = std::move(objects);
    finish_scene(scene);
    return scene;
}

} // namespace

Object object_of(std::uint32_t shape, const Mat4& to_world) {
    Object object;
    object.shape = shape;
    object.materials = {0};
    object.place(to_world);
    return object;
}

Scene make_scene(std::vector<Shape> shapes) {
    std::vector<Object> objects;
    for (std::uint32_t i = 0; i < shapes.size(); ++i) objects.push_back(object_of(i, Mat4()));
    return finished(std::move(shapes), std::move(objects));
}

Scene make_scene(Shape shape, const std::vector<Mat4>& placements) {
    std::vector<Object> objects;
    for (const Mat4& placement : placements) objects.push_back(object_of(0, placement));
    return finished({std::move(shape)}, std::move(objects));
}

Hit brute_force_hit(const Scene& scene, const Ray& ray) {
    Hit best;
    const auto consider = [&](const Hit& hit) {
        if (raytrace::precedes(hit, best)) best = hit;
    };
    for (std::uint32_t o = 0; o < scene.objects.size(); ++o) {
        const Object& object = scene.objects[o];
        const ObjectTransform transform = object_transform(object, ray.time);
        const bool identity = object.identity && !object.moving;
        const Ray inside = identity ? ray : to_object_space(ray, transform.to_world, transform.to_object);
        const ShearedRay sheared(inside);
        const Shape& shape = scene.shapes[object.shape];
        for (std::uint32_t p = 0; p < primitive_count(shape); ++p) {
            if (const auto* sphere = std::get_if<Sphere>(&shape)) {
                if (const auto t = intersect_sphere(inside, *sphere)) consider({o, p, 0, 0, *t});
            } else if (const auto* list = std::get_if<QuadList>(&shape)) {
                if (const auto h = intersect_quad(sheared, list->quads[p])) consider({o, p, h->u, h->v, h->t});
            } else {
                const PrimitiveVertices c = primitive_vertices(shape, p);
                if (const auto h = intersect_triangle(sheared, c.p[0], c.p[1], c.p[2]))
                    consider({o, p, h->u, h->v, h->t});
            }
        }
    }
    return best;
}

Mesh icosphere(int levels, float bump) {
    const float g = (1 + std::sqrt(5.0f)) / 2;
    Mesh mesh;
    for (const Vec3& p :
         {Vec3(-1, g, 0), Vec3(1, g, 0), Vec3(-1, -g, 0), Vec3(1, -g, 0), Vec3(0, -1, g), Vec3(0, 1, g),
          Vec3(0, -1, -g), Vec3(0, 1, -g), Vec3(g, 0, -1), Vec3(g, 0, 1), Vec3(-g, 0, -1), Vec3(-g, 0, 1)})
        mesh.positions.push_back(normalize(p));
    mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                      {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                      {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    for (int level = 0; level < levels; ++level) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [it, fresh] =
                middles.try_emplace(std::pair(min(a, b), max(a, b)), static_cast<std::uint32_t>(mesh.positions.size()));
            if (fresh) mesh.positions.push_back(normalize(mesh.positions[a] + mesh.positions[b]));
            return it->second;
        };
        std::vector<std::array<std::uint32_t, 3>> finer;
        for (const auto& [a, b, c] : mesh.triangles) {
            const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        mesh.triangles = std::move(finer);
    }
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        mesh.positions[i] *= 1 + bump * (2 * unit_float(high_bits(stream_number(1, i))) - 1);
    return mesh;
}

Mesh scaled_and_moved(Mesh mesh, float scale, Vec3 shift) {
    for (Vec3& p : mesh.positions) p = p * scale + shift;
    return mesh;
}

} // namespace duet::compare
