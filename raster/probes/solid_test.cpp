#include "raster/probes/solid_test.h"

namespace duet::raster {
namespace {

/// Returns whether the ray from p along +y meets the triangle, seen along y: an edge belongs to one of its sides.
bool above(Vec3d p, Vec3d a, Vec3d b, Vec3d c) {
    const auto left = [&](Vec3d from, Vec3d to) { // of the edge, as seen from p
        return (to.x - from.x) * (p.z - from.z) - (to.z - from.z) * (p.x - from.x) > 0;
    };
    const bool ab = left(a, b), bc = left(b, c), ca = left(c, a);
    if (ab != bc || bc != ca) return false;
    const Vec3d n = cross(b - a, c - a);
    return n.y != 0 && dot(n, a - p) / n.y > 0;
}

bool contains(const Sphere& sphere, Vec3d p) {
    return length(p - Vec3d(sphere.center)) < static_cast<double>(sphere.radius);
}
/// Counts the crossings of a ray to infinity (Shimrat 1962, "Algorithm 112: Position of Point Relative to Polygon").
bool contains(const Mesh& mesh, Vec3d p) {
    bool inside = false;
    for (const auto& t : mesh.triangles)
        if (above(p, Vec3d(mesh.positions[t[0]]), Vec3d(mesh.positions[t[1]]), Vec3d(mesh.positions[t[2]])))
            inside = !inside;
    return inside;
}
bool contains(const QuadList& list, Vec3d p) {
    bool inside = false;
    for (const Quad& quad : list.quads) {
        const auto c = corners(quad);
        if (above(p, Vec3d(c[0]), Vec3d(c[1]), Vec3d(c[2])) != above(p, Vec3d(c[0]), Vec3d(c[2]), Vec3d(c[3])))
            inside = !inside;
    }
    return inside;
}

} // namespace

bool inside_solid(const RasterSceneData& data, Vec3d p) {
    const Scene& scene = data.scene;
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        if (!data.objects[i].closed) continue;
        const Box3& box = data.objects[i].bounds;
        const Vec3 q(p);
        if (q.x < box.low.x || q.y < box.low.y || q.z < box.low.z || q.x > box.high.x || q.y > box.high.y ||
            q.z > box.high.z)
            continue;
        const Object& object = scene.objects[i];
        const Vec3d local = object.identity ? p : transform_point(Mat4d(object.to_object), p);
        if (std::visit([&](const auto& shape) { return contains(shape, local); }, scene.shapes[object.shape]))
            return true;
    }
    return false;
}

} // namespace duet::raster
