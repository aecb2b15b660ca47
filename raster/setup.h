// Stage 4: what a triangle's coverage and interpolation need, set up once.
#pragma once

#include "common/system/sabotage.h"
#include "raster/samples.h"
#include "raster/transform.h"

#include <array>
#include <cstdint>
#include <optional>

namespace duet::raster {

/// Half-open ranges of pixels.
struct PixelRect {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

    bool empty() const { return x0 >= x1 || y0 >= y1; }
};
PixelRect intersect(const PixelRect& a, const PixelRect& b);

/// The line through two grid points as an integer function of the sample's place: a·x + b·y + c >= 0 where the sample
/// is inside. The interior of a positive (clockwise in the picture) triangle is where all its edges' are. c carries the
/// top-left rule: a sample on the edge is inside only if the edge is the triangle's left or top one, so of two
/// triangles that share it exactly one has the sample. (Pineda 1988, «A Parallel Algorithm for Polygon Rasterization».)
struct EdgeFunction {
    std::int64_t a, b, c;

    EdgeFunction(FixedPoint from, FixedPoint to);
    std::int64_t at(std::int64_t x, std::int64_t y) const {
        const std::int64_t value = a * x + b * y + c;
        return sabotaged(Guard::kWideEdges) ? static_cast<std::int32_t>(value) : value;
    }
};

/// What an interpolated barycentric triple means for Hit::u and v.
enum class Piece : std::uint8_t {
    kTriangle,   ///< corners a, b, c
    kQuadFirst,  ///< corner, +u, +u+v
    kQuadSecond, ///< corner, +u+v, +v
};

/// Barycentrics and depth at a sample, in the unsnapped, unclipped triangle, or the quad that it is a half of; a sample
/// outside is taken to a point inside.
struct Interpolated {
    double b0, b1, b2; ///< in proportion to the barycentrics, not normalized; >= 0, but beyond a quad's diagonal
    double sum;        ///< of the three, > 0
    double depth_sum;  ///< depth × sum
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

/// A triangle that is ready to be drawn: its snapped outline says which samples it covers, its interpolation what is
/// there.
struct SetupTriangle {
    std::array<FixedPoint, 3> corners; ///< of positive area
    std::uint32_t object = 0, primitive = 0;
    Piece piece = Piece::kTriangle;
    Interpolation interpolation;
};

/// The pixels in which a sample of `offset` lies within the closed box that three grid points span.
PixelRect pixels_within(const std::array<FixedPoint, 3>& corners, SampleOffset offset);

} // namespace duet::raster
