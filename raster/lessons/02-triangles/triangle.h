// Which pixels a triangle covers.
#pragma once

#include "common/vec/vec.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace duet::lesson {

/// A point of the picture in units of 1/256 pixel. Whole numbers make the tests below exact.
struct FixedPoint {
    std::int64_t x = 0, y = 0;
};
inline constexpr std::int64_t kSubpixels = 256;

/// The nearest point of the 1/256 pixel grid. Coordinates are pixels from the upper left corner, within ±2^22.
inline FixedPoint snap(Vec2 p) { return {std::llround(p.x * kSubpixels), std::llround(p.y * kSubpixels)}; }

/// Twice the area of the triangle a, b, p: positive where p lies to the right of the way from a to b (y points down),
/// zero on the line. (Pineda 1988, "A Parallel Algorithm for Polygon Rasterization")
inline std::int64_t edge_function(FixedPoint a, FixedPoint b, FixedPoint p) {
    return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

/// Whether a point exactly on the edge from a to b belongs to the triangle on its right. It does for top edges and left
/// edges alone, so of two triangles that share an edge just one gets the point.
inline bool is_top_left(FixedPoint a, FixedPoint b) { return b.y < a.y || (b.y == a.y && b.x > a.x); }

/// Calls visit(x, y, weights) for each pixel of a width × height picture whose center the triangle covers. The weights
/// (barycentric coordinates) of a, b and c sum to 1. Corners in either order; coordinates in pixels.
template <typename Visit>
void for_each_pixel(Vec2 a_pixels, Vec2 b_pixels, Vec2 c_pixels, int width, int height, const Visit& visit) {
    const FixedPoint a = snap(a_pixels), b = snap(b_pixels), c = snap(c_pixels);
    const std::int64_t area = edge_function(a, b, c);
    if (area == 0) return; // the corners lie on one line
    if (area < 0) {        // the other way round: swap two corners, and their weights back
        const auto swapped = [&](int x, int y, Vec3 w) { visit(x, y, Vec3{w.x, w.z, w.y}); };
        return for_each_pixel(a_pixels, c_pixels, b_pixels, width, height, swapped);
    }
    const auto first = [](std::int64_t low) { return static_cast<int>(std::max<std::int64_t>(low / kSubpixels, 0)); };
    const auto last = [](std::int64_t high, int size) {
        return static_cast<int>(std::min<std::int64_t>(high / kSubpixels, size - 1));
    };
    for (int y = first(std::min({a.y, b.y, c.y})); y <= last(std::max({a.y, b.y, c.y}), height); ++y)
        for (int x = first(std::min({a.x, b.x, c.x})); x <= last(std::max({a.x, b.x, c.x}), width); ++x) {
            const FixedPoint p{x * kSubpixels + kSubpixels / 2, y * kSubpixels + kSubpixels / 2};
            const std::int64_t wa = edge_function(b, c, p), wb = edge_function(c, a, p), wc = edge_function(a, b, p);
            const auto covers = [](std::int64_t w, bool owns_edge) { return w > 0 || (w == 0 && owns_edge); };
            if (covers(wa, is_top_left(b, c)) && covers(wb, is_top_left(c, a)) && covers(wc, is_top_left(a, b))) {
                const float scale = 1 / static_cast<float>(area);
                visit(x, y, Vec3(Vec3T<std::int64_t>(wa, wb, wc)) * scale);
            }
        }
}

} // namespace duet::lesson
