#include "raster/geometry/cull.h"

namespace duet::raster {

CullCounts& CullCounts::operator+=(const CullCounts& other) {
    backfaces += other.backfaces;
    outside += other.outside;
    subpixel += other.subpixel;
    degenerate += other.degenerate;
    return *this;
}

bool outside_frustum(const Box3& box, const Pinhole& pinhole, const Viewport& viewport) {
    if (box.empty()) return true;
    unsigned shared = kFrustum;
    for (unsigned corner = 0; corner < 8 && shared != 0; ++corner) {
        const Vec4d h = pinhole.world_to_pixel * Vec4d(Vec3d(box.corner(corner)), 1.0);
        shared &= outcode({.xw = h.x, .yw = h.y, .w = h.w, .depth = h.z}, viewport);
    }
    return shared != 0;
}

bool may_cull_backfaces(const TransformedObject& object, bool solid) {
    return solid && (object.any_outside & kNear) == 0;
}

std::int64_t doubled_area(FixedPoint a, FixedPoint b, FixedPoint c) {
    const std::int64_t abx = std::int64_t{b.x} - a.x, aby = std::int64_t{b.y} - a.y;
    const std::int64_t acx = std::int64_t{c.x} - a.x, acy = std::int64_t{c.y} - a.y;
    return abx * acy - aby * acx;
}

} // namespace duet::raster
