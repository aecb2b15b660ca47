#include "common/geometry/quad.h"

namespace duet {

std::optional<TriangleHit> intersect_quad(const ShearedRay& ray, const std::array<Vec3, 4>& p) {
    if (const auto hit = intersect_triangle(ray, p[0], p[1], p[2])) // corner + β·u + γ·(u + v)
        return TriangleHit{hit->t, min(hit->u + hit->v, 1.0f), hit->v};
    if (const auto hit = intersect_triangle(ray, p[0], p[2], p[3])) // corner + β·(u + v) + γ·v
        return TriangleHit{hit->t, hit->u, min(hit->u + hit->v, 1.0f)};
    return std::nullopt;
}

} // namespace duet
