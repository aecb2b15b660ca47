// Stage 4: what a triangle's coverage and interpolation need, set up once.
#pragma once

#include "common/system/sabotage.h"
#include "common/vec/scalar.h"
#include "raster/geometry/cull.h"
#include "raster/geometry/packed_shape.h"
#include "raster/geometry/samples.h"
#include "raster/geometry/tiles.h"
#include "raster/geometry/transform.h"
#include "raster/lanes.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>

namespace duet::raster {

inline int ceil_pixel(std::int32_t x) { return (x + kSubPixels - 1) >> kSubPixelBits; }
inline int floor_pixel(std::int32_t x) { return x >> kSubPixelBits; }

/// The line through two grid points as an integer function of the sample's place: a·x + b·y + c >= 0 where the sample
/// is inside. The interior of a positive (clockwise in the picture) triangle is where all its edges' are. c carries the
/// top-left rule: a sample on the edge is inside only if the edge is the triangle's left or top one, so of two
/// triangles that share it exactly one has the sample. (Pineda 1988, «A Parallel Algorithm for Polygon Rasterization».)
struct EdgeFunction {
    std::int64_t a, b, c;

    EdgeFunction(FixedPoint from, FixedPoint to) {
        const std::int64_t dx = std::int64_t{to.x} - from.x, dy = std::int64_t{to.y} - from.y;
        a = -dy;
        b = dx;
        c = dy * from.x - dx * from.y;
        // The interior of a positive triangle lies to the right of an edge that runs up, and below one that runs right.
        const bool left_or_top = (dy < 0) | ((dy == 0) & (dx > 0)); // without branches: no machine guesses those
        c -= !left_or_top & !sabotaged(Guard::kTopLeftRule);
    }
    std::int64_t at(std::int64_t x, std::int64_t y) const {
        const std::int64_t value = a * x + b * y + c;
        return sabotaged(Guard::kWideEdges) ? static_cast<std::int32_t>(value) : value;
    }
};

/// A nearness as a tile keeps it.
inline float kept_nearness(double nearness) {
    const auto n = static_cast<float>(nearness);
    return sabotaged(Guard::kReversedDepth) ? 1 - (1 - n) : n; // as the books': 0 near, 1 far
}

/// Barycentrics and depth at a sample, in the unsnapped, unclipped triangle, or the quad that it is a half of; a sample
/// outside is taken to a point inside.
struct Interpolated {
    double b0, b1, b2; ///< in proportion to the barycentrics, not normalized; >= 0, but beyond a quad's diagonal
    double sum;        ///< of the three, > 0
    double depth_sum;  ///< depth × sum

    /// near / depth. Moved to the triangle's border, a point may come to lie before the near plane at which the outline
    /// was cut.
    double nearness(double near) const { return depth_sum > near * sum ? near * sum / depth_sum : 1.0; }
};

/// Nearness, near / depth, over the picture. Under perspective it is linear, in an orthographic view its inverse is.
/// Pixels are counted from one beside the outline (origin); all in double, so that the one rounding to float is all the
/// error that counts.
struct NearnessPlane {
    double x = 0, y = 0, constant = 0;
};

/// Perspective-correct barycentrics without a division by w: with homogeneous pixel vertices Vᵢ = (xw, yw, w), eᵢ(x, y)
/// = (x, y, 1)·(Vⱼ × Vₖ) is linear in the pixel and bᵢ = eᵢ / Σe, also where vertices lie behind the eye (Olano and
/// Greer 1997, «Triangle Scan Conversion using 2D Homogeneous Coordinates»). Pixels are counted from one beside the
/// triangle, so that the products that cancel are of the triangle's size and not of the picture's; all in double.
struct Interpolation {
    double origin_x = 0, origin_y = 0;
    std::array<Vec3d, 3> e; ///< e[i] = coefficients of x, y, 1; positive inside, whichever side is seen
    Vec3d depth;            ///< of the three vertices

    Interpolation() = default;
    Interpolation(const PixelVertex& a, const PixelVertex& b, const PixelVertex& c, FixedPoint beside);
    Interpolated at(Vec2d pixel, Piece piece) const;

private:
    Vec2d mirrored_inside(Vec2d p) const;
    Vec2d nearest_on_outline(Vec2d p) const;
};

/// A triangle as its mesh has it, or a half of a quad, before any clipping.
struct WholeTriangle {
    PixelVertex a, b, c;
    Piece piece = Piece::kTriangle;
};

/// A triangle that is ready to be drawn: its snapped outline says which samples it covers, the plane how near it is
/// there. What else is asked of a sample follows from the whole triangle, whose number it has.
struct alignas(64) DrawTriangle { // a line of the cache
    std::array<FixedPoint, 3> corners; ///< of positive area
    bool sound = false;    ///< its plane can be trusted, as that of a triangle seen edge-on can not
    bool clipped = false;  ///< the outline is a part of it only, with corners of its own
    std::uint32_t id = 0;  ///< in order of (object, primitive)
    float nearest = 1;     ///< no sample is nearer
    NearnessPlane nearness{};
};

/// The box that three points span. (Two by two: std::min of a list branches.)
inline FixedPoint least(const std::array<FixedPoint, 3>& p) {
    return {std::min(std::min(p[0].x, p[1].x), p[2].x), std::min(std::min(p[0].y, p[1].y), p[2].y)};
}
inline FixedPoint most(const std::array<FixedPoint, 3>& p) {
    return {std::max(std::max(p[0].x, p[1].x), p[2].x), std::max(std::max(p[0].y, p[1].y), p[2].y)};
}

/// A pixel beside the outline, within the picture: where Interpolation and NearnessPlane count from.
struct Origin {
    int x, y;
};
inline Origin origin(const std::array<FixedPoint, 3>& p, const Viewport& viewport) {
    const FixedPoint low = least(p);
    return {floor_pixel(std::clamp(low.x, 0, viewport.width * kSubPixels)),
            floor_pixel(std::clamp(low.y, 0, viewport.height * kSubPixels))};
}
/// At one sample, the naive way.
Interpolated interpolate(const WholeTriangle& whole, Vec2d pixel);
/// About the outline's origin.
Interpolation interpolation(const WholeTriangle& whole, const std::array<FixedPoint, 3>& corners,
                            const Viewport& viewport);
/// Completes a triangle from its plane of nearness and its corners' least depth. `clipped`: its outline is a part only.
void set_plane(DrawTriangle& triangle, const NearnessPlane& plane, double least_depth, bool clipped, double near);
/// From the whole triangle and an outline of positive area, its own or one of its clipped parts'.
DrawTriangle set_up(const WholeTriangle& whole, const std::array<FixedPoint, 3>& corners, std::uint32_t id,
                    bool clipped, const Viewport& viewport);

/// The pixels in which a sample of `offset` lies within the closed box that three grid points span.
inline PixelRect pixels_within(const std::array<FixedPoint, 3>& p, SampleOffset offset) {
    const FixedPoint low = least(p), high = most(p);
    return {ceil_pixel(low.x - offset.x), ceil_pixel(low.y - offset.y), floor_pixel(high.x - offset.x) + 1,
            floor_pixel(high.y - offset.y) + 1};
}

/// How far inside of each edge of the snapped outline, in values of its edge function, a sample that the outline covers must
/// lie to be inside of the unsnapped triangle's, too, for certain. Snapping moves each corner by at most half a grid point
/// along x and y. With a and b the ways from the sample to an edge's ends, its function a × b changes by at most
/// ½|a| + ½|b| + ½, where |v| = |x| + |y|. |a| + |b| is convex in the sample: so at a sample of which the third corner's
/// barycentric is β, it is at most (1 − β)·L + β·(M + N), L being the edge's length and M and N the other two's, in the same
/// measure. As β = a × b / A, A the doubled area, a × b ≥ (½L + ½) / (1 − (M + N − L) / 2A) is enough. Where
/// A ≥ 4·(L + M + N), that is less than ⅝L + 1. In slivers w + h + 1 is, w and h being the sides of the box that bounds the
/// corners, for |a| and |b| are at most w + h, which is ½ (L + M + N). New corners, where it is clipped, have rounding errors
/// besides: a whole pixel is left to them.
///
/// T is a number or a batch of them; `lengths` L of each edge.
template <typename T> std::array<T, 3> edge_margins(const std::array<T, 3>& lengths, T doubled_area) {
    using xsimd::select, duet::select;
    const T circumference = lengths[0] + lengths[1] + lengths[2];
    const auto sliver = doubled_area < circumference * T(4);
    const T of_sliver = (circumference >> 1) + T(1);
    std::array<T, 3> margins;
    for (std::size_t k = 0; k < 3; ++k) margins[k] = select(sliver, of_sliver, T((lengths[k] * T(5) >> 3) + T(2)));
    return margins;
}
inline std::array<std::int64_t, 3> edge_margins(const DrawTriangle& triangle) {
    const auto& p = triangle.corners;
    std::array<std::int64_t, 3> lengths; // of edges from corner k to the next
    for (std::size_t k = 0; k < 3; ++k) {
        const FixedPoint &a = p[k], &b = p[(k + 1) % 3];
        lengths[k] = std::abs(std::int64_t{b.x} - a.x) + std::abs(std::int64_t{b.y} - a.y);
    }
    if (triangle.clipped) {
        const std::int64_t size = (lengths[0] + lengths[1] + lengths[2]) / 2, margin = size + 1 + size * kSubPixels;
        return {margin, margin, margin};
    }
    return edge_margins(lengths, doubled_area(p[0], p[1], p[2]));
}

} // namespace duet::raster
