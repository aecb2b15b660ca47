#include "raster/geometry/clip.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace duet::raster {
namespace {

/// Represents a half-space of homogeneous coordinates. A point is inside where x·xw + y·yw + w·w + depth·depth +
/// constant >= 0.
struct Plane {
    double x, y, w, depth, constant;

    double distance(const PixelVertex& v) const { return x * v.xw + y * v.yw + w * v.w + depth * v.depth + constant; }
};

/// Interpolates from the end that is nearer to the plane: from an end 1e18 meters away, the other one's coordinates
/// would be lost.
PixelVertex cut(const PixelVertex& a, const PixelVertex& b, double a_distance, double b_distance) {
    if (std::abs(a_distance) > std::abs(b_distance)) return cut(b, a, b_distance, a_distance);
    // The signs differ, so there is no cancellation.
    return between(a, b, a_distance / (a_distance - b_distance));
}

ClippedPolygon clip(const ClippedPolygon& polygon, const Plane& plane) {
    ClippedPolygon result;
    const auto emit = [&](const PixelVertex& v) {
        // A convex polygon gains one vertex per plane. Rounding can make it cross a plane more than twice. The
        // ninth corner is then within rounding error of the plane and may be dropped.
        if (result.count < static_cast<int>(result.vertices.size()))
            result.vertices[static_cast<std::size_t>(result.count++)] = v;
    };
    for (int i = 0; i < polygon.count; ++i) {
        const PixelVertex& a = polygon.vertices[static_cast<std::size_t>(i)];
        const PixelVertex& b = polygon.vertices[static_cast<std::size_t>((i + 1) % polygon.count)];
        const double da = plane.distance(a), db = plane.distance(b);
        if (da >= 0) emit(a);
        if (da >= 0 && db < 0) emit(cut(a, b, da, db));
        if (da < 0 && db >= 0) emit(cut(b, a, db, da));
    }
    if (result.count < 3) result.count = 0;
    return result;
}

} // namespace

ClippedPolygon clip(const PixelVertex& a, const PixelVertex& b, const PixelVertex& c, const Viewport& viewport) {
    const double right = viewport.width + kGuardBand, bottom = viewport.height + kGuardBand;
    const Plane planes[] = {
        {0, 0, 0, 1, -viewport.near}, {1, 0, kGuardBand, 0, 0}, {-1, 0, right, 0, 0},
        {0, 1, kGuardBand, 0, 0},     {0, -1, bottom, 0, 0},
    };
    ClippedPolygon polygon{{a, b, c}, 3};
    for (const Plane& plane : planes) {
        polygon = clip(polygon, plane);
        if (&plane != planes) continue;
        // A corner on the near plane must have exactly that depth. Interpolated between distant ends it could be
        // anything near zero. Under perspective, w equals the depth.
        for (PixelVertex& v : std::span(polygon.vertices).first(static_cast<std::size_t>(polygon.count))) {
            const bool perspective = v.w == v.depth;
            v.depth = std::max(v.depth, viewport.near);
            if (perspective) v.w = v.depth;
        }
    }
    return polygon;
}

} // namespace duet::raster
