// This header serves edge-aware filters. It loads the neighbors of a batch of pixels, and tests whether they lie on the
// same surface.
#pragma once

#include "raster/gbuffer/plane.h"
#include "raster/gbuffer/screen_projection.h"

namespace duet::raster {

/// Returns the greatest distance in meters between a point of reversed depth `depth` and the plane of another point, if
/// the two may be averaged.
inline Floats plane_tolerance(const ScreenProjection& projection, const Floats& depth) {
    constexpr float kPixels = 2; // widths of a pixel there
    return Floats(kPixels) * projection.pixel_size(Floats(projection.near()) / max(depth, Floats(1e-30f)));
}

/// Loads a batch that starts at any column, with columns and rows beyond the plane's edges clamped.
inline Floats load_at(const PlaneFloat& plane, int x, int y) {
    const float* row = plane.row(std::clamp(y, 0, plane.height() - 1));
    if (x >= 0 && x + static_cast<int>(Floats::size) <= plane.width()) return Floats::load_unaligned(row + x);
    const Floats column = Floats(static_cast<float>(x)) + load(kLanesAsFloats, 0);
    return gather(row, truncated(clamp(column, Floats(0.0f), Floats(static_cast<float>(plane.width() - 1)))));
}
inline Vec3T<Floats> load_at(const Planes3& planes, int x, int y) {
    return {load_at(planes.x, x, y), load_at(planes.y, x, y), load_at(planes.z, x, y)};
}

/// Returns the similarity of two surface points, in [0, 1]. It is 0 if q lies farther than `tolerance` meters from the
/// plane through p, and decreases with the angle between the unit normals n and m.
inline Floats likeness(const Vec3T<Floats>& p, const Vec3T<Floats>& n, const Floats& tolerance,
                       const Vec3T<Floats>& q, const Vec3T<Floats>& m) {
    const Floats off = abs(dot(q - p, n)) / tolerance, turn = max(dot(n, m), Floats(0.0f));
    const Floats square = turn * turn;
    return max(Floats(1.0f) - off, Floats(0.0f)) * square * square;
}

} // namespace duet::raster
