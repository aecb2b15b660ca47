#include "common/geometry/triangle.h"

#include "common/system/sabotage.h"
#include "common/vec/box.h"
#include "common/vec/robust.h"

#include <cmath>
#include <utility>

namespace duet {

ShearedRay::ShearedRay(const Ray& ray)
    : origin(ray.origin), direction(ray.direction), t_min(ray.t_min), t_max(ray.t_max) {
    kz = longest_axis(abs(ray.direction));
    kx = (kz + 1) % 3;
    ky = (kx + 1) % 3;
    if (ray.direction[kz] < 0) std::swap(kx, ky); // keeps the triangle's winding
    sx = ray.direction[kx] / ray.direction[kz];
    sy = ray.direction[ky] / ray.direction[kz];
    sz = 1 / ray.direction[kz];
}

namespace {

// The bound on the error of the distance t = Σ bᵢ zᵢ, after Pharr, Jakob and Humphreys 2023, §6.8.7; products ordered
// so that they stay in range wherever the edge functions do.
float distance_error(const Vec3& at, const Vec3& bt, const Vec3& ct, float e0, float e1, float e2, float inv_det) {
    const float max_z = max(max(abs(at.z), abs(bt.z)), abs(ct.z));
    const float delta_z = gamma_bound(3) * max_z;
    const float max_x = max(max(abs(at.x), abs(bt.x)), abs(ct.x));
    const float max_y = max(max(abs(at.y), abs(bt.y)), abs(ct.y));
    const float delta_x = gamma_bound(5) * (max_x + max_z);
    const float delta_y = gamma_bound(5) * (max_y + max_z);
    const float delta_e = 2 * (gamma_bound(2) * max_x * max_y + delta_y * max_x + delta_x * max_y) * abs(inv_det);
    const float max_e = max(max(abs(e0), abs(e1)), abs(e2)) * abs(inv_det);
    return 3 * (gamma_bound(3) * max_e * max_z + delta_e * max_z + delta_z * max_e);
}

// Whether the triangle is a needle as the ray sees it. The sheared coordinates are off by some u·max_z, an edge
// function by that times the triangle's width: the hit moves along the triangle by as much over det, across depths of
// `spread`. That is no more than z's own rounding, but where the triangle is much thinner than it is deep.
bool is_needle(const Vec3& at, const Vec3& bt, const Vec3& ct, float inv_det) {
    const float width = max(max(abs(at.x), abs(bt.x)), abs(ct.x)) + max(max(abs(at.y), abs(bt.y)), abs(ct.y));
    const float spread = max(max(at.z, bt.z), ct.z) - min(min(at.z, bt.z), ct.z);
    return width * abs(inv_det) * spread > 8;
}

// Where on the triangle the ray hits it, or comes next to it by a rounding, in double from the unrounded differences.
TriangleHit needle_hit(const ShearedRay& ray, Vec3 a, Vec3 b, Vec3 c, const TriangleHit& rounded) {
    const Vec3d o(ray.origin), d(ray.direction), pa = Vec3d(a) - o, pb = Vec3d(b) - o, pc = Vec3d(c) - o;
    double e0 = dot(d, cross(pb, pc)), e1 = dot(d, cross(pc, pa)), e2 = dot(d, cross(pa, pb));
    const double sign = std::copysign(1.0, e0 + e1 + e2);
    e0 = max(sign * e0, 0.0), e1 = max(sign * e1, 0.0), e2 = max(sign * e2, 0.0);
    const double det = e0 + e1 + e2;
    if (!(det > 0)) return rounded;
    const double z = (e0 * pa[ray.kz] + e1 * pb[ray.kz] + e2 * pc[ray.kz]) / det;
    return {static_cast<float>(z / d[ray.kz]), static_cast<float>(e1 / det), static_cast<float>(e2 / det)};
}

// The distance to the triangle's plane in double, from the unrounded differences: its sign is right even for an origin
// that is one float away from the plane of a triangle a million times as wide.
double plane_distance(const ShearedRay& ray, Vec3 a, Vec3 b, Vec3 c) {
    const Vec3d pa(a);
    const Vec3d n = cross(Vec3d(b) - pa, Vec3d(c) - pa);
    return dot(n, pa - Vec3d(ray.origin)) / dot(n, Vec3d(ray.direction));
}

} // namespace

std::optional<TriangleHit> intersect_triangle(const ShearedRay& ray, Vec3 a, Vec3 b, Vec3 c) {
    // Vertices relative to the ray's origin, sheared so that the ray runs along +z: the test is one of the origin
    // in a 2D triangle. The same edge gives the same numbers in both of its triangles: no ray slips between.
    const auto sheared = [&](Vec3 p) {
        const Vec3 q = p - ray.origin;
        return Vec3(q[ray.kx] - ray.sx * q[ray.kz], q[ray.ky] - ray.sy * q[ray.kz], ray.sz * q[ray.kz]);
    };
    const Vec3 at = sheared(a), bt = sheared(b), ct = sheared(c);
    const auto edge = [](Vec3 p, Vec3 q) {
        if (sabotaged(Guard::kUnfusedEdges)) return std::fma(p.x, q.y, -(p.y * q.x));
        return p.x * q.y - p.y * q.x;
    };
    float e0 = edge(ct, bt), e1 = edge(at, ct), e2 = edge(bt, at);
    if (e0 == 0 || e1 == 0 || e2 == 0) { // exactly on an edge, or rounded to it: double decides (Woop et al., §3.2)
        const auto cross2 = [](float x1, float y1, float x2, float y2) {
            return static_cast<float>(static_cast<double>(x1) * static_cast<double>(y2) -
                                      static_cast<double>(y1) * static_cast<double>(x2));
        };
        e0 = cross2(ct.x, ct.y, bt.x, bt.y);
        e1 = cross2(at.x, at.y, ct.x, ct.y);
        e2 = cross2(bt.x, bt.y, at.x, at.y);
    }
    if ((e0 < 0 || e1 < 0 || e2 < 0) && (e0 > 0 || e1 > 0 || e2 > 0)) return std::nullopt;
    const float det = e0 + e1 + e2;
    if (!(det != 0)) return std::nullopt;
    const float inv_det = 1 / det;
    TriangleHit hit{0, e1 * inv_det, e2 * inv_det};
    hit.t = e0 * inv_det * at.z + hit.u * bt.z + hit.v * ct.z;
    if (is_needle(at, bt, ct, inv_det) && !sabotaged(Guard::kNeedles)) hit = needle_hit(ray, a, b, c, hit);
    // Within its error of the ray's origin (or out of range) t says nothing: is this the surface the ray has just left,
    // or one that touches it?
    const bool uncertain = !(abs(hit.t) > distance_error(at, bt, ct, e0, e1, e2, inv_det));
    if (uncertain && !sabotaged(Guard::kPlaneDistance)) hit.t = static_cast<float>(plane_distance(ray, a, b, c));
    if (!(hit.t > ray.t_min && hit.t <= ray.t_max)) return std::nullopt;
    return hit;
}

} // namespace duet
