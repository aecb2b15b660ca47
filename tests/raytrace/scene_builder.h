// This header builds scenes for tests.
#pragma once

#include "common/scene/scene.h"

#include <cmath>
#include <map>
#include <utility>

namespace duet::raytrace {

struct SceneBuilder {
    Scene scene;

    std::uint32_t material(Material material) {
        scene.materials.push_back(std::move(material));
        scene.material_names.push_back("material " + std::to_string(scene.materials.size()));
        return static_cast<std::uint32_t>(scene.materials.size() - 1);
    }
    std::uint32_t shape(Shape shape) {
        scene.shapes.push_back(std::move(shape));
        return static_cast<std::uint32_t>(scene.shapes.size() - 1);
    }
    /// Adds an object with its own shape and an identity transform.
    std::uint32_t add(Shape new_shape, std::uint32_t material) {
        return place(shape(std::move(new_shape)), material, Mat4());
    }
    std::uint32_t place(std::uint32_t shape_index, std::uint32_t material, const Mat4& to_world) {
        return place_moving(shape_index, material, to_world, to_world);
    }
    std::uint32_t place_moving(std::uint32_t shape_index, std::uint32_t material, const Mat4& begin, const Mat4& end) {
        Object object;
        object.name = "object " + std::to_string(scene.objects.size());
        object.shape = shape_index;
        object.materials = {material};
        object.to_world = begin;
        object.to_world_end = end;
        object.to_object = Mat4(inverse_affine(Mat4d(begin)));
        object.moving = !(begin == end);
        object.identity = begin == Mat4() && !object.moving;
        scene.objects.push_back(std::move(object));
        return static_cast<std::uint32_t>(scene.objects.size() - 1);
    }
    Scene finish() {
        finish_scene(scene);
        return std::move(scene);
    }
};

inline QuadList quad(Vec3 corner, Vec3 u, Vec3 v) { return {{Quad{corner, u, v}}}; }

/// Returns a unit sphere of 20·4^levels triangles, in which adjacent triangles share their vertices.
inline Mesh icosphere(int levels, float radius = 1, Vec3 center = {}, bool smooth = false) {
    const float g = (1 + std::sqrt(5.0f)) / 2;
    Mesh mesh;
    std::vector<Vec3> unit;
    for (const Vec3& p :
         {Vec3(-1, g, 0), Vec3(1, g, 0), Vec3(-1, -g, 0), Vec3(1, -g, 0), Vec3(0, -1, g), Vec3(0, 1, g),
          Vec3(0, -1, -g), Vec3(0, 1, -g), Vec3(g, 0, -1), Vec3(g, 0, 1), Vec3(-g, 0, -1), Vec3(-g, 0, 1)})
        unit.push_back(normalize(p));
    mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                      {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                      {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    for (int level = 0; level < levels; ++level) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [it, fresh] =
                middles.try_emplace(std::pair(min(a, b), max(a, b)), static_cast<std::uint32_t>(unit.size()));
            if (fresh) unit.push_back(normalize(unit[a] + unit[b]));
            return it->second;
        };
        std::vector<std::array<std::uint32_t, 3>> finer;
        for (const auto& [a, b, c] : mesh.triangles) {
            const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        mesh.triangles = std::move(finer);
    }
    for (const Vec3& n : unit) mesh.positions.push_back(center + n * radius);
    if (smooth) mesh.normals = unit;
    return mesh;
}

} // namespace duet::raytrace
