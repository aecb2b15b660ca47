// The library's triangles: its grid, edge functions and sample rectangle (raster/geometry/setup.h).
#include "raster/geometry/setup.h"
#include "raster/lessons/02-triangles/lab.h"

namespace duet::lab {

using raster::EdgeFunction, raster::FixedPoint;

GridPoint snap(Vec2 p) {
    const FixedPoint s = raster::snap({.xw = p.x, .yw = p.y, .w = 1, .depth = 1});
    return {s.x, s.y};
}

std::int64_t edge_function(GridPoint a, GridPoint b, GridPoint p) {
    return raster::doubled_area({a.x, a.y}, {b.x, b.y}, {p.x, p.y});
}

bool is_top_left(GridPoint a, GridPoint b) { // a point on the edge is inside
    return EdgeFunction({a.x, a.y}, {b.x, b.y}).at(a.x, a.y) >= 0;
}

namespace {

/// Calls visit(x, y, weights) for each covered pixel, with the weights of the corners in the order given.
template <typename Visit> void visit_pixels(const Triangle& t, int width, int height, const Visit& visit) {
    std::array<FixedPoint, 3> p;
    for (std::size_t i = 0; i < 3; ++i) {
        const GridPoint s = snap(t.corners[i]);
        p[i] = {s.x, s.y};
    }
    const std::int64_t area = raster::doubled_area(p[0], p[1], p[2]);
    if (area == 0) return;
    if (area < 0) std::swap(p[1], p[2]);
    const std::array edges{EdgeFunction(p[1], p[2]), EdgeFunction(p[2], p[0]), EdgeFunction(p[0], p[1])};
    const raster::PixelRect rect = raster::pixels_within(p, {});
    for (int y = std::max(rect.y0, 0); y < std::min(rect.y1, height); ++y)
        for (int x = std::max(rect.x0, 0); x < std::min(rect.x1, width); ++x) {
            std::array<std::int64_t, 3> w;
            for (std::size_t i = 0; i < 3; ++i) w[i] = edges[i].at(256 * x + 128, 256 * y + 128);
            if (w[0] < 0 || w[1] < 0 || w[2] < 0) continue;
            if (area < 0) std::swap(w[1], w[2]);
            const auto weight = [&](std::size_t i) {
                return static_cast<float>(w[i]) / static_cast<float>(std::abs(area));
            };
            visit(x, y, Vec3{weight(0), weight(1), weight(2)});
        }
}

} // namespace

Image<int> count_coverage(const std::vector<Triangle>& triangles, int width, int height) {
    Image<int> count(width, height, 0);
    for (const Triangle& t : triangles) visit_pixels(t, width, height, [&](int x, int y, Vec3) { ++count(x, y); });
    return count;
}

ImageRgb draw(const std::vector<Triangle>& triangles, int width, int height, Rgb background) {
    ImageRgb image(width, height, background);
    for (const Triangle& t : triangles)
        visit_pixels(t, width, height, [&](int x, int y, Vec3 w) {
            image(x, y) = t.colors[0] * w.x + t.colors[1] * w.y + t.colors[2] * w.z;
        });
    return image;
}

} // namespace duet::lab
