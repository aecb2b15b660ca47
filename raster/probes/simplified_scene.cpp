#include "raster/probes/simplified_scene.h"

#include "raster/geometry/simplify_mesh.h"

#include <algorithm>
#include <cmath>

namespace duet::raster {
namespace {

constexpr std::size_t kFewTriangles = 4096; ///< meshes with fewer are drawn as fast as they are simplified
constexpr std::size_t kGain = 2; ///< a mesh is simplified if it has at least this many times as many triangles as then

/// Returns the largest factor by which a transform stretches a vector along an axis.
double largest_scale(const Mat4& m) {
    double most = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        Vec3d unit;
        unit[axis] = 1;
        most = std::max(most, length(transform_vector(Mat4d(m), unit)));
    }
    return most;
}

} // namespace

std::optional<Scene> simplified_scene(const RasterSceneData& data, double cell) {
    const Scene& scene = data.scene;
    std::vector<double> scales(scene.shapes.size()); // of a shape's largest instance; 0 if it must stay as it is
    std::vector<bool> kept(scene.shapes.size());
    for (const std::uint32_t i : data.polygonal) {
        const Object& object = scene.objects[i];
        scales[object.shape] = std::max(scales[object.shape], largest_scale(object.to_world));
        const auto emits = [&](std::uint32_t m) { return emitter(scene.materials[m]) != nullptr; };
        if (std::ranges::any_of(object.materials, emits)) kept[object.shape] = true;
    }
    for (const std::uint32_t i : data.alpha_polygonal) kept[scene.objects[i].shape] = true;
    std::optional<Scene> result;
    for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
        const Mesh* mesh = std::get_if<Mesh>(&scene.shapes[i]);
        if (mesh == nullptr || kept[i] || !(scales[i] > 0) || mesh->triangles.size() < kFewTriangles) continue;
        Mesh simple = simplified(*mesh, cell / scales[i]);
        if (simple.triangles.size() * kGain > mesh->triangles.size()) continue;
        if (!result) result = scene;
        result->shapes.edit(i) = std::move(simple);
    }
    return result;
}

} // namespace duet::raster
