// Ray and triangle.
#pragma once

#include "common/vec/ray.h"

#include <cstdint>
#include <optional>

namespace duet {

/// Where a ray meets a triangle abc: distance t, and the barycentric coordinates u of b and v of c.
struct TriangleHit {
    float t, u, v;
};

/// A ray prepared for watertight tests: its largest axis becomes z, and a shear takes its direction to (0, 0, 1)
/// (Woop, Benthin and Wald 2013, «Watertight Ray/Triangle Intersection», §3).
struct ShearedRay {
    Vec3 origin, direction;
    std::size_t kx, ky, kz;
    float sx, sy, sz;
    float t_min, t_max;

    explicit ShearedRay(const Ray& ray);
};

/// Watertight: a ray through a shared edge or vertex of a closed mesh hits at least one of its triangles. Both sides
/// are hit; a triangle seen edge-on or of zero area is missed. The test uses the unsnapped float vertices.
std::optional<TriangleHit> intersect_triangle(const ShearedRay& ray, Vec3 a, Vec3 b, Vec3 c);

} // namespace duet
