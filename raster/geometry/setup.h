// Implements stage 4, triangle setup, which computes once per triangle what coverage and interpolation need.
#pragma once

#include "common/vec/scalar.h"
#include "raster/geometry/cull.h"
#include "raster/geometry/packed_shape.h"
#include "raster/geometry/packet.h"
#include "raster/geometry/sample_positions.h"
#include "raster/geometry/tiles.h"
#include "raster/geometry/transform.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>

namespace duet::raster {

/// Converts a fixed-point coordinate to the first whole pixel at or after it.
inline int ceil_pixel(std::int32_t x) { return (x + kSubpixels - 1) >> kSubpixelBits; }
/// Converts a fixed-point coordinate to the last whole pixel at or before it.
inline int floor_pixel(std::int32_t x) { return x >> kSubpixelBits; }

/// Represents the edge function of two grid points, an integer function of the sample position: a·x + b·y + c >= 0
/// where the sample is inside. The interior of a positive triangle (clockwise in the image) is where all three edge
/// functions are inside. c includes the top-left rule: a sample on an edge is inside only if it is a left or top edge
/// of the triangle, so exactly one of two triangles that share the edge covers the sample. (Pineda 1988, "A Parallel
/// Algorithm for Polygon Rasterization".)
struct EdgeFunction {
    std::int64_t a, b, c;

    EdgeFunction(FixedPoint from, FixedPoint to) {
        const std::int64_t dx = std::int64_t{to.x} - from.x, dy = std::int64_t{to.y} - from.y;
        a = -dy;
        b = dx;
        c = dy * from.x - dx * from.y;
        // The interior of a positive triangle lies to the right of an edge that runs up, and below one that runs
        // right.
        const bool left_or_top = (dy < 0) | ((dy == 0) & (dx > 0)); // branchless, because branch prediction fails here
        c -= !left_or_top;
    }
    std::int64_t at(std::int64_t x, std::int64_t y) const { return a * x + b * y + c; }
};

/// Converts a reversed depth to the precision in which a tile stores it.
inline float to_stored_depth(double reversed_depth) { return static_cast<float>(reversed_depth); }

/// Holds barycentrics and depth at a sample, in the unsnapped, unclipped triangle, or in the quad of which it is one
/// half. A sample outside the triangle is moved to a point inside.
struct Interpolated {
    /// The weights are proportional to the barycentrics, but not normalized. They are >= 0, except beyond a quad's
    /// diagonal.
    double b0, b1, b2;
    double sum;        ///< b0 + b1 + b2, > 0
    double depth_sum;  ///< depth × sum, depth in meters

    /// Returns the reversed depth, near / depth, clamped to 1. A point that was moved to the triangle's boundary
    /// may lie in front of the near plane at which the snapped triangle was clipped.
    double reversed_depth(double near) const { return depth_sum > near * sum ? near * sum / depth_sum : 1.0; }
};

/// Represents a linear function of the pixel that gives the reversed depth, near / depth. It is the reversed depth
/// itself under perspective, and its inverse in an orthographic view. Pixel coordinates are relative to origin(). All
/// is in double, so that only the final rounding to float matters.
struct DepthPlane {
    double x = 0, y = 0, constant = 0;
};

/// Computes perspective-correct barycentrics without a division by w. With homogeneous pixel vertices Vᵢ = (xw, yw,
/// w), eᵢ(x, y) = (x, y, 1)·(Vⱼ × Vₖ) is linear in the pixel and bᵢ = eᵢ / Σe, even for vertices behind
/// the eye (Olano and Greer 1997, "Triangle Scan Conversion using 2D Homogeneous Coordinates"). Pixel coordinates are
/// relative to a pixel near the triangle, so that products that cancel have the size of the triangle and not of the
/// image. All is in double.
struct Interpolation {
    double origin_x = 0, origin_y = 0;
    std::array<Vec3d, 3> e;        ///< e[i] = coefficients of x, y, 1; positive inside, for front and back faces
    std::array<Vec3d, 3> vertices; ///< xw, yw, w
    bool is_edge_on = false;       ///< whether the sign of the area is only rounding error
    Vec3d depth;                   ///< camera-space depths of the three vertices, meters

    Interpolation() = default;
    Interpolation(const PixelVertex& a, const PixelVertex& b, const PixelVertex& c, FixedPoint beside);
    /// Interpolates at a position in pixels; outside of the triangle, at a nearby position inside or on its boundary.
    Interpolated at(Vec2d pixel, TriangleKind triangle_kind) const;

private:
    Vec2d mirrored_inside(Vec2d p) const;
    Vec2d nearest_on_boundary(Vec2d p) const;
    Interpolated edge_on(Vec2d p) const;
    double rounding_error(const std::array<const PixelVertex*, 3>& corners) const;
};

/// Represents a triangle of a mesh, or one half of a quad, before clipping.
struct UnclippedTriangle {
    PixelVertex a, b, c;
    TriangleKind triangle_kind = TriangleKind::kTriangle;
};

/// Represents a triangle that is ready to be rasterized. The snapped corners determine the covered samples, and the
/// plane gives the reversed depth at each. All other attributes are interpolated in the whole (unclipped, unsnapped)
/// triangle with this id.
struct alignas(64) DrawTriangle { // one cache line
    std::array<FixedPoint, 3> corners; ///< snapped corners, of positive area
    bool plane_reliable = false;       ///< false for a triangle seen edge-on
    bool clipped = false;  ///< whether the corners are those of a clipped part
    std::uint32_t id = 0;  ///< id in the order of (object, primitive)
    float nearest = 1;     ///< upper bound of the reversed depth of its samples
    DepthPlane depth_plane{};
};

/// Returns the minimum corner of the points' bounding box. (Nested std::min calls compile without branches;
/// std::min of a list does not.)
inline FixedPoint min_corner(const std::array<FixedPoint, 3>& p) {
    return {std::min(std::min(p[0].x, p[1].x), p[2].x), std::min(std::min(p[0].y, p[1].y), p[2].y)};
}
/// Returns the maximum corner of the points' bounding box.
inline FixedPoint max_corner(const std::array<FixedPoint, 3>& p) {
    return {std::max(std::max(p[0].x, p[1].x), p[2].x), std::max(std::max(p[0].y, p[1].y), p[2].y)};
}

/// Represents the pixel at the lower corner of the triangle's bounding box, clamped to the image. Interpolation and
/// DepthPlane count pixels from it.
struct Origin {
    int x, y;
};
/// Returns the origin for a triangle with these snapped corners.
inline Origin origin(const std::array<FixedPoint, 3>& p, const Viewport& viewport) {
    const FixedPoint low = min_corner(p);
    return {floor_pixel(std::clamp(low.x, 0, viewport.width * kSubpixels)),
            floor_pixel(std::clamp(low.y, 0, viewport.height * kSubpixels))};
}
/// Interpolates at one sample without a precomputed setup. It is the reference for the faster paths.
Interpolated interpolate(const UnclippedTriangle& whole, Vec2d pixel);
/// Returns the interpolation relative to origin(corners, viewport).
Interpolation interpolation(const UnclippedTriangle& whole, const std::array<FixedPoint, 3>& corners,
                            const Viewport& viewport);
/// Sets the depth plane and the fields that follow from it. `min_depth` is the minimum over the corners of the whole
/// triangle, in meters. `clipped` says that the corners are those of a clipped part.
void set_plane(DrawTriangle& triangle, const DepthPlane& plane, double min_depth, bool clipped, double near);
/// Sets up a triangle. `corners`, of positive area, are the snapped corners of the whole triangle or of a clipped
/// part.
DrawTriangle set_up(const UnclippedTriangle& whole, const std::array<FixedPoint, 3>& corners, std::uint32_t id,
                    bool clipped, const Viewport& viewport);

/// Returns the pixels whose sample at `offset` lies within the closed bounding box of three grid points.
inline PixelRect pixels_within(const std::array<FixedPoint, 3>& p, SampleOffset offset) {
    const FixedPoint low = min_corner(p), high = max_corner(p);
    return {ceil_pixel(low.x - offset.x), ceil_pixel(low.y - offset.y), floor_pixel(high.x - offset.x) + 1,
            floor_pixel(high.y - offset.y) + 1};
}

/// Returns for each edge of the snapped triangle the least value of its edge function at which a covered sample is
/// certainly inside the unsnapped triangle as well.
///
/// Derivation: snapping moves each corner by at most half a grid point along x and y. With a and b the vectors from
/// the sample to the ends of an edge, its function a × b changes by at most ½|a| + ½|b| + ½, where |v| = |x| +
/// |y|. |a| + |b| is convex in the sample. So at a sample whose barycentric of the third corner is β, it is at most
/// (1 − β)·L + β·(M + N), where L is the length of the edge and M and N are the lengths of the other two, in
/// the same norm. As β = a × b / A, with A the doubled area, a × b ≥ (½L + ½) / (1 − (M + N − L) / 2A) is
/// sufficient. Where A ≥ 4·(L + M + N), this bound is less than ⅝L + 1. In slivers, w + h + 1 is sufficient,
/// with w and h the sides of the corners' bounding box, because |a| and |b| are at most w + h, which is ½ (L + M +
/// N). The new corners of a clipped triangle have additional rounding errors, for which a whole pixel is reserved.
///
/// T is a number or a SIMD batch. `lengths` holds L of each edge.
template <typename T> std::array<T, 3> edge_margins(const std::array<T, 3>& lengths, T doubled_area) {
    using xsimd::select, duet::select;
    const T circumference = lengths[0] + lengths[1] + lengths[2];
    const auto sliver = doubled_area < circumference * T(4);
    const T sliver_margin = (circumference >> 1) + T(1);
    std::array<T, 3> margins;
    for (std::size_t k = 0; k < 3; ++k) margins[k] = select(sliver, sliver_margin, T((lengths[k] * T(5) >> 3) + T(2)));
    return margins;
}
inline std::array<std::int64_t, 3> edge_margins(const DrawTriangle& triangle) {
    const auto& p = triangle.corners;
    std::array<std::int64_t, 3> lengths; // length of the edge from corner k to the next
    for (std::size_t k = 0; k < 3; ++k) {
        const FixedPoint &a = p[k], &b = p[(k + 1) % 3];
        lengths[k] = std::abs(std::int64_t{b.x} - a.x) + std::abs(std::int64_t{b.y} - a.y);
    }
    if (triangle.clipped) {
        const std::int64_t size = (lengths[0] + lengths[1] + lengths[2]) / 2, margin = size + 1 + size * kSubpixels;
        return {margin, margin, margin};
    }
    return edge_margins(lengths, doubled_area(p[0], p[1], p[2]));
}

} // namespace duet::raster
