// Implements stage 1, which transforms vertices from object space to pixel coordinates.
#pragma once

#include "common/camera/camera.h"
#include "common/scene/scene.h"

#include <array>
#include <cstdint>
#include <vector>

namespace duet::raster {

/// Represents a vertex in homogeneous pixel coordinates. It appears at (xw/w, yw/w) where depth and w are positive.
struct PixelVertex {
    double xw = 0, yw = 0, w = 1;
    double depth = 0; ///< camera-space −z, meters; equals w under perspective
};

/// Returns the vertex at the fraction t of the way from a to b.
inline PixelVertex between(const PixelVertex& a, const PixelVertex& b, double t) {
    const auto mix = [t](double from, double to) { return from + (to - from) * t; };
    return {mix(a.xw, b.xw), mix(a.yw, b.yw), mix(a.w, b.w), mix(a.depth, b.depth)};
}

/// Represents a point on the sub-pixel grid, in 1/256 pixel.
struct FixedPoint {
    std::int32_t x = 0, y = 0;
    friend bool operator==(const FixedPoint&, const FixedPoint&) = default;
};

/// Stores the parameters of the view that the stages need.
struct Viewport {
    int width = 0, height = 0;
    double near = 0; ///< distance of the near plane, meters
    bool orthographic = false;
};
/// Returns the viewport of a view through a pinhole.
Viewport viewport_of(const View& view, const Pinhole& pinhole);

/// The guard band is how far beyond the image edges a vertex may lie before its primitives are clipped, in pixels.
/// With images of up to kMaxRenderSide = 2^14 pixels per side, fixed-point coordinates stay below 2^24.4 and edge
/// functions below 2^52, which is exact in 64 bits.
inline constexpr double kGuardBand = 65536;

/// Each bit says that a vertex lies outside one clip plane. A primitive whose vertices share a frustum bit is
/// invisible.
enum Outcode : std::uint8_t {
    kLeft = 1, ///< more than a pixel beyond the image edge, so snapping can't move it inside
    kRight = 2,
    kTop = 4,
    kBottom = 8,
    kNear = 16,  ///< in front of the near plane, or behind the eye
    kGuard = 32, ///< outside the guard band on any side
    kFrustum = kLeft | kRight | kTop | kBottom | kNear,
    kMustClip = kNear | kGuard,
};
/// Returns the bits of the planes that the vertex is outside of.
std::uint8_t outcode(const PixelVertex& vertex, const Viewport& viewport);

/// Rounds a vertex to the nearest grid point. Requires w > 0 and a position within the guard band.
FixedPoint snap(const PixelVertex& vertex);

/// Represents a vertex that is rounded to the grid.
struct SnappedVertex {
    FixedPoint p; ///< meaningless where the outcode has a bit of kMustClip
    std::uint32_t outcode = 0;
};

/// Stores the vertices of an object in pixel coordinates. Quads have four per primitive (corner, +u, +u+v, +v); a
/// mesh has its own.
struct TransformedObject {
    std::uint32_t object = 0; ///< index into Scene::objects
    bool mirrored = false;    ///< the transform has a negative determinant, so windings are flipped
    Mat4d to_pixel;           ///< result of object_to_pixel()
    Mat4d to_pixel_transposed; ///< transpose of `to_pixel`: its columns are contiguous
    std::vector<SnappedVertex> vertices;
    unsigned any_outside = 0; ///< bitwise or of all outcodes
};

/// Returns the matrix from object space to homogeneous pixel coordinates at `time`. It is one product in double, so
/// no world-space position is rounded and a vertex is as exact as the object's floats.
Mat4d object_to_pixel(const Object& object, const Pinhole& pinhole, float time);
/// Transforms a vertex by the object's matrix. Recomputing it where it is needed is cheaper than storing it. The
/// loop over the four rows vectorizes.
inline PixelVertex pixel_vertex(const TransformedObject& object, Vec3 p) {
    const auto& m = object.to_pixel_transposed.m;
    const double x = static_cast<double>(p.x), y = static_cast<double>(p.y), z = static_cast<double>(p.z);
    std::array<double, 4> v;
    for (std::size_t r = 0; r < 4; ++r) v[r] = m[0][r] * x + m[1][r] * y + m[2][r] * z + m[3][r];
    return {.xw = v[0], .yw = v[1], .w = v[3], .depth = v[2]};
}

/// Transforms the meshes and quads of the listed objects in parallel. `result` gets one entry per object, in order.
/// The memory of an earlier `result` is reused.
void transform(const Scene& scene, const std::vector<std::uint32_t>& objects, const Pinhole& pinhole, float time,
               const Viewport& viewport, int threads, std::vector<TransformedObject>& result);

} // namespace duet::raster
