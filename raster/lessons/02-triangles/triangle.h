// Which pixels a triangle covers.
#pragma once

#include "common/vec/vec.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace duet::lesson {

/// A point of the picture in units of 1/256 pixel. Whole numbers make the tests below exact.
struct FixedPoint {
    std::int64_t x = 0, y = 0;
};
inline constexpr std::int64_t kSubpixels = 256;

/// The nearest point of the 1/256 pixel grid. Coordinates are pixels from the upper left corner, within ±2^22.
inline FixedPoint snap(Vec2 p) { return {std::llround(p.x * kSubpixels), std::llround(p.y * kSubpixels)}; }

/// The center of a pixel. It decides whether a triangle covers the pixel.
inline FixedPoint pixel_center(int x, int y) {
    return {x * kSubpixels + kSubpixels / 2, y * kSubpixels + kSubpixels / 2};
}

/// Twice the area of the triangle a, b, p: positive where p lies to the right of the way from a to b (y points down),
/// negative to the left of it, zero on the line. (Pineda 1988, "A Parallel Algorithm for Polygon Rasterization")
inline std::int64_t edge_function(FixedPoint a, FixedPoint b, FixedPoint p) {
    return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

/// Whether a point exactly on the edge from a to b belongs to the triangle on its right. It does for top edges and left
/// edges alone, so of two triangles that share an edge just one gets the point.
inline bool is_top_left(FixedPoint a, FixedPoint b) { return b.y < a.y || (b.y == a.y && b.x > a.x); }

/// Whether a point with the value w of an edge's function is inside of that edge.
inline bool is_inside(std::int64_t w, FixedPoint a, FixedPoint b) { return w > 0 || (w == 0 && is_top_left(a, b)); }

/// Calls visit(x, y, weights) for each pixel of a width × height picture whose center the triangle covers. The weights
/// (barycentric coordinates) of a, b and c sum to 1. Corners in either order; coordinates in pixels.
template <typename Visit>
void for_each_pixel(Vec2 a_pixels, Vec2 b_pixels, Vec2 c_pixels, int width, int height, const Visit& visit) {
    FixedPoint a = snap(a_pixels), b = snap(b_pixels), c = snap(c_pixels);
    const bool turned = edge_function(a, b, c) < 0;
    if (turned) std::swap(b, c); // now the inside is to the right of all three edges
    const auto area = static_cast<float>(edge_function(a, b, c));
    if (area == 0) return; // the corners lie on one line
    const auto pixel = [](std::int64_t x, int size) {
        return int(std::clamp<std::int64_t>(x / kSubpixels, 0, size - 1));
    };
    for (int y = pixel(std::min({a.y, b.y, c.y}), height); y <= pixel(std::max({a.y, b.y, c.y}), height); ++y)
        for (int x = pixel(std::min({a.x, b.x, c.x}), width); x <= pixel(std::max({a.x, b.x, c.x}), width); ++x) {
            const FixedPoint p = pixel_center(x, y);
            const std::int64_t wa = edge_function(b, c, p), wb = edge_function(c, a, p), wc = edge_function(a, b, p);
            if (!is_inside(wa, b, c) || !is_inside(wb, c, a) || !is_inside(wc, a, b)) continue;
            const Vec3 weights = Vec3{float(wa), float(wb), float(wc)} / area;
            visit(x, y, turned ? Vec3{weights.x, weights.z, weights.y} : weights);
        }
}

} // namespace duet::lesson
