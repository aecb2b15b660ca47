// Stage 1: vertices from their object's space to the picture.
#pragma once

#include "common/camera/camera.h"
#include "common/scene/scene.h"
#include "raster/geometry/samples.h"

#include <array>
#include <cstdint>
#include <vector>

namespace duet::raster {

/// A vertex in homogeneous pixel coordinates: it is seen at (xw/w, yw/w) where depth and w are positive.
struct PixelVertex {
    double xw = 0, yw = 0, w = 1;
    double depth = 0; ///< camera-space −z, metres; equals w under perspective
};

/// A point on the sub-pixel grid, in 1/256 pixel.
struct FixedPoint {
    std::int32_t x = 0, y = 0;
    friend bool operator==(const FixedPoint&, const FixedPoint&) = default;
};

/// What the stages need to know of the picture's frame.
struct Viewport {
    int width = 0, height = 0;
    double near = 0; ///< smallest depth seen
    bool orthographic = false;
};
Viewport viewport_of(const View& view, const Pinhole& pinhole);

/// How far beyond the picture's edges a vertex may lie before its primitives are clipped, in pixels. With pictures of
/// up to kMaxPictureSide = 2^14 pixels a side fixed-point coordinates stay below 2^24.4 and edge functions below 2^52:
/// exact in 64 bits.
inline constexpr double kGuardBand = 65536;

/// On which outer sides of what a vertex lies; a primitive whose vertices share a frustum bit can't be seen.
enum Outcode : std::uint8_t {
    kLeft = 1, ///< more than a pixel beyond the picture's edge: snapping can't bring it back
    kRight = 2,
    kTop = 4,
    kBottom = 8,
    kNear = 16,  ///< before the near plane, or behind the eye
    kGuard = 32, ///< beyond the guard band on any side
    kFrustum = kLeft | kRight | kTop | kBottom | kNear,
    kMustClip = kNear | kGuard,
};
std::uint8_t outcode(const PixelVertex& vertex, const Viewport& viewport);

/// Rounded to the nearest grid point. The vertex needs w > 0 and a place within the guard band.
FixedPoint snap(const PixelVertex& vertex);

struct SnappedVertex {
    FixedPoint p; ///< meaningless where the outcode has a bit of kMustClip
    std::uint32_t outcode = 0;
};

/// An object's vertices in the picture. Quads have four a primitive (corner, +u, +u+v, +v); a mesh has its own.
struct TransformedObject {
    std::uint32_t object = 0; ///< index into Scene::objects
    bool mirrored = false;    ///< its transform has a negative determinant: windings are flipped
    Mat4d to_pixel;           ///< object_to_pixel
    Mat4d to_pixel_columns;   ///< its transpose: its columns lie together
    std::vector<SnappedVertex> vertices;
    unsigned any_outside = 0; ///< all outcodes or-ed
};

/// The map of an object's space to homogeneous pixels at a time. One product in double, so no world position is
/// rounded: a vertex is as exact as the object's floats.
Mat4d object_to_pixel(const Object& object, const Pinhole& pinhole, float time);
/// A vertex under an object's map: cheap enough to be worked out again where it is needed, instead of being kept. The
/// four rows side by side.
inline PixelVertex pixel_vertex(const TransformedObject& object, Vec3 p) {
    const auto& m = object.to_pixel_columns.m;
    const double x = static_cast<double>(p.x), y = static_cast<double>(p.y), z = static_cast<double>(p.z);
    std::array<double, 4> v;
    for (std::size_t r = 0; r < 4; ++r) v[r] = m[0][r] * x + m[1][r] * y + m[2][r] * z + m[3][r];
    return {.xw = v[0], .yw = v[1], .w = v[3], .depth = v[2]};
}

/// Transforms the meshes and quads of the listed objects, in parallel; the result has one entry an object, in order.
/// `result` may be an earlier one, whose memory is used again.
void transform(const Scene& scene, const std::vector<std::uint32_t>& objects, const Pinhole& pinhole, float time,
               const Viewport& viewport, int threads, std::vector<TransformedObject>& result);

} // namespace duet::raster
