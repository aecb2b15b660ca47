#include "common/geometry/footprint.h"

namespace duet {

void set_footprint(const RayFootprint& footprint, Vec3 direction, SurfacePoint& point) {
    const Vec3d n(point.ng), d(direction), dpdu(point.dpdu), dpdv(point.dpdv);
    const double det = dot(n, cross(dpdu, dpdv));
    if (det == 0) return;
    const auto uv_step = [&](Vec3 offset) {
        const Vec3d q(offset);
        const Vec3d dp = q - d * (dot(n, q) / dot(n, d));
        return Vec2(Vec2d(dot(n, cross(dp, dpdv)), dot(n, cross(dpdu, dp))) * (1 / det));
    };
    point.duv_dx = uv_step(footprint.dx);
    point.duv_dy = uv_step(footprint.dy);
}

} // namespace duet
