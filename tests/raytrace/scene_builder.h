// This header builds scenes for tests.
#pragma once

#include "common/scene/scene.h"
#include "compare/stress/accelerated_scene.h"

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
        object.place(begin, end);
        scene.objects.push_back(std::move(object));
        return static_cast<std::uint32_t>(scene.objects.size() - 1);
    }
    Scene finish() {
        finish_scene(scene);
        return std::move(scene);
    }
};

inline QuadList quad(Vec3 corner, Vec3 u, Vec3 v) { return {{Quad{corner, u, v}}}; }

/// Returns a sphere of 20·4^levels triangles, in which adjacent triangles share their vertices.
inline Mesh icosphere(int levels, float radius = 1, Vec3 center = {}, bool smooth = false) {
    Mesh mesh = compare::icosphere(levels);
    if (smooth) mesh.normals = mesh.positions;
    for (Vec3& p : mesh.positions) p = center + p * radius;
    return mesh;
}

} // namespace duet::raytrace
