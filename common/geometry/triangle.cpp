#include "common/geometry/triangle.h"

#include "common/system/sabotage.h"
#include "common/vec/box.h"

#include <cmath>
#include <utility>

namespace duet {

namespace {

// Where on the triangle the ray hits it, or comes next to it by a rounding, in double from the unrounded differences.
TriangleHit needle_hit(const ShearedRay& ray, Vec3 a, Vec3 b, Vec3 c, const TriangleHit& rounded) {
    const Vec3d o(ray.origin), d(ray.direction), pa = Vec3d(a) - o, pb = Vec3d(b) - o, pc = Vec3d(c) - o;
    double e0 = dot(d, cross(pb, pc)), e1 = dot(d, cross(pc, pa)), e2 = dot(d, cross(pa, pb));
    const double sign = std::copysign(1.0, e0 + e1 + e2);
    e0 = max(sign * e0, 0.0), e1 = max(sign * e1, 0.0), e2 = max(sign * e2, 0.0);
    const double det = e0 + e1 + e2;
    if (!(det > 0)) return rounded;
    const std::size_t z_axis = ray.shear.kz;
    const double z = (e0 * pa[z_axis] + e1 * pb[z_axis] + e2 * pc[z_axis]) / det;
    return {static_cast<float>(z / d[z_axis]), static_cast<float>(e1 / det), static_cast<float>(e2 / det)};
}

} // namespace

std::optional<TriangleHit> intersect_triangle(const ShearedRay& ray, Vec3 a, Vec3 b, Vec3 c) {
    TriangleTest<float> test(ray.shear, a, b, c);
    float &e0 = test.e0, &e1 = test.e1, &e2 = test.e2;
    if (e0 == 0 || e1 == 0 || e2 == 0) { // exactly on an edge, or rounded to it: double decides (Woop et al., §3.2)
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
    if (test.is_needle(inv_det, ray.shear.speed)) hit = needle_hit(ray, a, b, c, hit);
    // Within its error of the ray's origin (or out of range) t says nothing: is this the surface the ray has just left,
    // or one that touches it?
    const bool uncertain = !(abs(hit.t) > test.distance_error(inv_det, ray.shear.speed));
    if (uncertain && !sabotaged(Guard::kPlaneDistance)) hit.t = plane_distance(ray, a, b, c);
    if (!(hit.t > ray.t_min && hit.t <= ray.t_max)) return std::nullopt;
    return hit;
}

} // namespace duet
