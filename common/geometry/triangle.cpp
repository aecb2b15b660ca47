#include "common/geometry/triangle.h"

#include "common/vec/box.h"

#include <array>
#include <limits>

namespace duet {

namespace {

// Returns the point on the boundary of a triangle that is nearest to a ray of direction d, for a ray that misses the
// triangle by a rounding error. p holds the vertices relative to the ray's origin.
TriangleHit nearest_boundary_hit(Vec3d d, const std::array<Vec3d, 3>& p) {
    const double size = dot(d, d);
    double nearest = std::numeric_limits<double>::infinity(), t = 0;
    std::array<double, 3> weights{};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        const double ti = dot(p[i], d) / size, tj = dot(p[j], d) / size;
        const Vec3d from = p[i] - d * ti, along = p[j] - d * tj - from; // perpendicular to the ray
        const double s = dot(along, along) > 0 ? clamp(-dot(from, along) / dot(along, along), 0.0, 1.0) : 0.0;
        const double distance = length_squared(from + along * s);
        if (!(distance < nearest)) continue;
        nearest = distance;
        t = lerp(ti, tj, s);
        weights = {};
        weights[i] = 1 - s;
        weights[j] = s;
    }
    return {static_cast<float>(t), static_cast<float>(weights[1]), static_cast<float>(weights[2])};
}

// Returns the hit of a ray on a needle triangle, or the nearest point of the boundary if the ray misses by a rounding
// error. The computation uses double and does not round the differences to float.
TriangleHit needle_hit(const ShearedRay& ray, Vec3 a, Vec3 b, Vec3 c) {
    const Vec3d o(ray.origin), d(ray.direction), pa = Vec3d(a) - o, pb = Vec3d(b) - o, pc = Vec3d(c) - o;
    const double e0 = dot(d, cross(pb, pc)), e1 = dot(d, cross(pc, pa)), e2 = dot(d, cross(pa, pb));
    const double det = e0 + e1 + e2;
    const bool inside = (e0 >= 0 && e1 >= 0 && e2 >= 0) || (e0 <= 0 && e1 <= 0 && e2 <= 0);
    if (!inside || det == 0) return nearest_boundary_hit(d, {pa, pb, pc});
    const std::size_t z_axis = ray.shear.kz;
    const double z = (e0 * pa[z_axis] + e1 * pb[z_axis] + e2 * pc[z_axis]) / det;
    return {static_cast<float>(z / d[z_axis]), static_cast<float>(e1 / det), static_cast<float>(e2 / det)};
}

} // namespace

std::optional<TriangleHit> intersect_triangle(const ShearedRay& ray, Vec3 a, Vec3 b, Vec3 c) {
    TriangleTest<float> test(ray.shear, a, b, c);
    float &e0 = test.e0, &e1 = test.e1, &e2 = test.e2;
    // Recompute the edge functions in double if one is 0: the ray is on an edge or was rounded to it (Woop et al.,
    // §3.2).
    if (e0 == 0 || e1 == 0 || e2 == 0) {
        const auto cross2 = [](Vec3 p, Vec3 q) {
            return static_cast<float>(static_cast<double>(p.x) * static_cast<double>(q.y) -
                                      static_cast<double>(p.y) * static_cast<double>(q.x));
        };
        e0 = cross2(test.ct, test.bt);
        e1 = cross2(test.at, test.ct);
        e2 = cross2(test.bt, test.at);
    }
    if ((e0 < 0 || e1 < 0 || e2 < 0) && (e0 > 0 || e1 > 0 || e2 > 0)) return std::nullopt;
    const float det = test.det();
    if (!(det != 0)) return std::nullopt;
    const float inv_det = 1 / det;
    TriangleHit hit{test.distance(inv_det), e1 * inv_det, e2 * inv_det};
    const bool needle = test.is_needle(inv_det, ray.shear.depth_per_t);
    if (needle) hit = needle_hit(ray, a, b, c);
    // If |t| is within its error bound (or is NaN), t cannot tell whether the triangle is the surface that the ray
    // leaves or another one that touches it. The more exact distance to the plane decides.
    const bool uncertain = !(abs(hit.t) > test.distance_error(inv_det, ray.shear.depth_per_t));
    if (uncertain) {
        const float plane = plane_distance(ray, a, b, c);
        if (!(plane > ray.t_min)) return std::nullopt;
        // For a needle, retain the previous t: a ray that misses it by a rounding error can intersect its plane far
        // away.
        if (!needle) hit.t = plane;
    }
    if (!(hit.t > ray.t_min && hit.t <= ray.t_max)) return std::nullopt;
    return hit;
}

} // namespace duet
