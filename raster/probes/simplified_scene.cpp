#include "raster/probes/simplified_scene.h"

#include "raster/geometry/simplify_mesh.h"

#include <algorithm>
#include <utility>

namespace duet::raster {
namespace {

constexpr std::size_t kFewTriangles = 4096; ///< meshes with fewer are drawn as fast as they are simplified

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

double area(const Mesh& mesh) {
    double twice = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3d corner(mesh.positions[a]);
        twice += length(cross(Vec3d(mesh.positions[b]) - corner, Vec3d(mesh.positions[c]) - corner));
    }
    return twice / 2;
}

/// Returns whether a simplified mesh has far fewer triangles than the mesh, but nearly its area. Leaves, which may be
/// smaller than the detail, lose theirs.
bool is_worth_it(const Mesh& simple, const Mesh& mesh) {
    constexpr std::size_t kFewer = 2;    // least ratio of the numbers of triangles
    constexpr double kLeastArea = 0.75; // rough surfaces lose some area as they become smooth
    return simple.triangles.size() * kFewer <= mesh.triangles.size() && area(simple) >= kLeastArea * area(mesh);
}

} // namespace

std::optional<Scene> simplified_scene(const RasterSceneData& data, double cell) {
    if (!(cell > 0)) return std::nullopt;
    const Scene& scene = data.scene;
    std::vector<double> scales(scene.shapes.size()); // of a shape's largest instance
    std::vector<bool> kept(scene.shapes.size());     // whether the shape must stay as it is
    for (const std::uint32_t i : data.polygonal) {
        const Object& object = scene.objects[i];
        for (const Mat4& m : {object.to_world, object.moving ? object.to_world_end : object.to_world})
            scales[object.shape] = std::max(scales[object.shape], largest_scale(m));
        const auto emits = [&](std::uint32_t m) { return emitter(scene.materials[m]) != nullptr; };
        if (std::ranges::any_of(object.materials, emits)) kept[object.shape] = true;
    }
    for (const std::uint32_t i : data.alpha_polygonal) kept[scene.objects[i].shape] = true;
    SharedList<Shape> shapes;
    bool any = false;
    for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
        const Mesh* mesh = std::get_if<Mesh>(&scene.shapes[i]);
        Mesh simple;
        if (mesh != nullptr && !kept[i] && scales[i] > 0 && mesh->triangles.size() >= kFewTriangles)
            simple = simplified(*mesh, cell / scales[i]);
        if (!simple.triangles.empty() && is_worth_it(simple, *mesh))
            shapes.push_back(Shape(std::move(simple))), any = true;
        else
            shapes.push_back(scene.shapes.shared(i));
    }
    if (!any) return std::nullopt;
    Scene result = scene;
    result.shapes = std::move(shapes);
    return result;
}

} // namespace duet::raster
