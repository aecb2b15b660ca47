#include "raytrace/bidirectional/camera_projection.h"

namespace duet::raytrace {

// A pixel of a perspective view covers the area |dx × dy| of the plane at depth 1, and thus the solid angle |dx ×
// dy|·cos³θ, with cos θ = depth / distance. At the distance d this is an area of |dx × dy|·cos³θ·d² perpendicular to
// the ray (Physically Based Rendering, 3rd edition, §16.1.1).
std::optional<SeenPoint> seen_through(const Pinhole& pinhole, Vec3d p) {
    const Vec3d projected = pinhole.project(p);
    const double depth = projected.z;
    if (!(depth >= pinhole.near) || !(depth > 0)) return std::nullopt;
    const Vec2d pixel(projected.x, projected.y);
    const double orthographic_area = length(cross(pinhole.origin_dx, pinhole.origin_dy));
    if (orthographic_area > 0) return SeenPoint{pixel, -pinhole.forward, depth - pinhole.near, 1 / orthographic_area};
    const Vec3d to_lens = pinhole.origin - p;
    const double distance = length(to_lens), area = length(cross(pinhole.direction_dx, pinhole.direction_dy));
    return SeenPoint{pixel, to_lens / distance, distance * (1 - pinhole.near / depth),
                     distance / (area * depth * sqr(depth))};
}

} // namespace duet::raytrace
