#include "common/geometry/triangle.h"

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
    float e0 = ct.x * bt.y - ct.y * bt.x;
    float e1 = at.x * ct.y - at.y * ct.x;
    float e2 = bt.x * at.y - bt.y * at.x;
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
    const float u = e1 * inv_det, v = e2 * inv_det;
    float t = e0 * inv_det * at.z + u * bt.z + v * ct.z;
    // Within its error of the ray's origin (or out of range) t says nothing: is this the surface the ray has just left,
    // or one that touches it?
    if (!(abs(t) > distance_error(at, bt, ct, e0, e1, e2, inv_det)))
        t = static_cast<float>(plane_distance(ray, a, b, c));
    if (!(t > ray.t_min && t <= ray.t_max)) return std::nullopt;
    return TriangleHit{t, u, v};
}

} // namespace duet
