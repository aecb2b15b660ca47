#include "raster/probes/solid_test.h"

#include "common/light/solid_angle.h"

#include <algorithm>
#include <array>

namespace duet::raster {
namespace {

/// Counts how often the six rays from a point along the axes leave a shape. A crossing into the shape counts as −1.
class AxisRays {
public:
    explicit AxisRays(Vec3d p) : p_(p) {}
    void cross(Vec3d a, Vec3d b, Vec3d c) {
        std::array<bool, 3> beside; // whether p lies beside the triangle's extent along an axis
        for (std::size_t i = 0; i < 3; ++i)
            beside[i] = p_[i] < std::min({a[i], b[i], c[i]}) || p_[i] > std::max({a[i], b[i], c[i]});
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (!beside[(axis + 1) % 3] && !beside[(axis + 2) % 3]) cross(a, b, c, axis);
    }
    /// Returns whether all rays but one agree that p is inside or outside.
    bool agree() const { return leaving(0) >= 5 || leaving(1) >= 5; }
    bool inside() const { return leaving(1) >= 5; }

private:
    std::ptrdiff_t leaving(int times) const { return std::ranges::count(crossings_, times); }

    /// Tests one axis. A ray through an edge may cross both of its triangles or none, but the other rays outvote it.
    void cross(Vec3d a, Vec3d b, Vec3d c, std::size_t axis) {
        const std::size_t i = (axis + 1) % 3, j = (axis + 2) % 3;
        const auto left = [&](Vec3d from, Vec3d to) { // whether p is to the left of the edge
            return (to[i] - from[i]) * (p_[j] - from[j]) - (to[j] - from[j]) * (p_[i] - from[i]) > 0;
        };
        const bool ab = left(a, b), bc = left(b, c), ca = left(c, a);
        if (ab != bc || bc != ca) return;
        const Vec3d n = duet::cross(b - a, c - a);
        const double behind = dot(n, a - p_);
        crossings_[2 * axis + (behind * n[axis] > 0)] += (behind > 0) - (behind < 0);
    }

    Vec3d p_;
    std::array<int, 6> crossings_{};
};

template <typename Visit> void for_each_triangle(const Mesh& mesh, const Visit& visit) {
    for (const auto& t : mesh.triangles)
        visit(Vec3d(mesh.positions[t[0]]), Vec3d(mesh.positions[t[1]]), Vec3d(mesh.positions[t[2]]));
}
template <typename Visit> void for_each_triangle(const QuadList& list, const Visit& visit) {
    for (const Quad& quad : list.quads) {
        const auto c = corners(quad);
        visit(Vec3d(c[0]), Vec3d(c[1]), Vec3d(c[2]));
        visit(Vec3d(c[0]), Vec3d(c[2]), Vec3d(c[3]));
    }
}

bool contains(const Sphere& sphere, Vec3d p) {
    return length(p - Vec3d(sphere.center)) < static_cast<double>(sphere.radius);
}
/// Tests by the generalized winding number, which is the mean of the signed crossings over all rays from p. If at least
/// five of six rays along the axes agree, they decide. Otherwise it is computed from solid angles.
template <typename Triangles> bool contains(const Triangles& shape, Vec3d p) {
    AxisRays rays(p);
    for_each_triangle(shape, [&](Vec3d a, Vec3d b, Vec3d c) { rays.cross(a, b, c); });
    if (rays.agree()) return rays.inside();
    double sum = 0;
    for_each_triangle(shape, [&](Vec3d a, Vec3d b, Vec3d c) { sum += solid_angle(a - p, b - p, c - p); });
    constexpr double kInside = 0.75; // above 1/2, which meshes with inconsistent orientation exceed outside
    return sum > kInside * 4 * kPiDouble;
}

Vec3d to_object_space(const RasterSceneData& data, std::uint32_t i, Vec3d p) {
    const Object& object = data.scene.objects[i];
    const auto time = static_cast<float>(data.scene.camera.shutter_open); // time at which probes are rendered
    return object.identity ? p : transform_point(Mat4d(object_transform(object, time).to_object), p);
}

} // namespace

bool is_inside(const RasterSceneData& data, std::uint32_t object, Vec3d p) {
    if (!data.objects[object].bounds.contains(Vec3(p))) return false;
    return std::visit([&](const auto& shape) { return contains(shape, to_object_space(data, object, p)); },
                      data.scene.shapes[data.scene.objects[object].shape]);
}

namespace {

/// Returns whether the segment from p to q crosses a triangle. Its ends must lie on different sides of the triangle's
/// plane, and the triangle's edges must all go around the segment in one direction.
bool crosses(Vec3d p, Vec3d q, Vec3d a, Vec3d b, Vec3d c) {
    const Vec3d n = cross(b - a, c - a), u = a - p, v = b - p, w = c - p, d = q - p;
    if ((dot(n, p - a) > 0) == (dot(n, q - a) > 0)) return false;
    const bool ab = dot(d, cross(u, v)) > 0, bc = dot(d, cross(v, w)) > 0, ca = dot(d, cross(w, u)) > 0;
    return ab == bc && bc == ca;
}
bool crosses(const Sphere&, Vec3d, Vec3d) { return true; }
template <typename Triangles> bool crosses(const Triangles& shape, Vec3d p, Vec3d q) {
    bool found = false;
    for_each_triangle(shape, [&](Vec3d a, Vec3d b, Vec3d c) { found = found || crosses(p, q, a, b, c); });
    return found;
}

/// Returns whether the camera looks at a point inside an object, from within or through an opening.
bool is_room(const RasterSceneData& data, std::uint32_t i) {
    const Camera& camera = data.scene.camera;
    if (is_inside(data, i, camera.eye)) return true;
    if (data.objects[i].closed || !is_inside(data, i, camera.look_at)) return false;
    return !std::visit(
        [&](const auto& shape) {
            return crosses(shape, to_object_space(data, i, camera.eye), to_object_space(data, i, camera.look_at));
        },
        data.scene.shapes[data.scene.objects[i].shape]);
}

} // namespace

SolidTest::SolidTest(const RasterSceneData& data, const RasterSceneData& simplified) : data_(simplified) {
    for (std::uint32_t i = 0; i < data.objects.size(); ++i)
        if (!is_room(data, i)) solids_.push_back(i);
}

bool SolidTest::inside(Vec3d p) const {
    return std::ranges::any_of(solids_, [&](std::uint32_t i) { return is_inside(data_, i, p); });
}

} // namespace duet::raster
