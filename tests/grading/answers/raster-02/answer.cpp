// Triangles by edge functions: every pixel of the bounding box is tested.
#include "raster/lessons/02-triangles/lab.h"

#include <algorithm>
#include <cmath>

namespace duet::lab {

GridPoint snap(Vec2 p) {
    const auto round = [](float x) { return static_cast<std::int32_t>(std::lround(x * 256)); };
    return {round(p.x), round(p.y)};
}

std::int64_t edge_function(GridPoint a, GridPoint b, GridPoint p) {
    const std::int64_t edge_x = b.x - a.x, edge_y = b.y - a.y;
    const std::int64_t to_x = p.x - a.x, to_y = p.y - a.y;
    return edge_x * to_y - edge_y * to_x;
}

bool is_top_left(GridPoint a, GridPoint b) {
    const bool left = b.y < a.y;
    const bool top = b.y == a.y && b.x > a.x;
    return left || top;
}

bool inside(std::int64_t w, GridPoint a, GridPoint b) {
    if (w == 0) return is_top_left(a, b);
    return w > 0;
}

/// Calls visit(x, y, wa, wb, wc) for each pixel that the triangle covers, with the weights of its corners.
template <typename Visit> void visit_pixels(Triangle triangle, int width, int height, Visit visit) {
    GridPoint a = snap(triangle.corners[0]), b = snap(triangle.corners[1]), c = snap(triangle.corners[2]);
    bool swapped = false;
    if (edge_function(a, b, c) < 0) {
        std::swap(b, c);
        swapped = true;
    }
    const float area = static_cast<float>(edge_function(a, b, c));
    if (area == 0) return;
    const int left = std::max(0, std::min({a.x, b.x, c.x}) / 256);
    const int right = std::min(width - 1, std::max({a.x, b.x, c.x}) / 256);
    const int top = std::max(0, std::min({a.y, b.y, c.y}) / 256);
    const int bottom = std::min(height - 1, std::max({a.y, b.y, c.y}) / 256);
    for (int y = top; y <= bottom; ++y) {
        for (int x = left; x <= right; ++x) {
            const GridPoint p{256 * x + 128, 256 * y + 128};
            const std::int64_t wa = edge_function(b, c, p);
            const std::int64_t wb = edge_function(c, a, p);
            const std::int64_t wc = edge_function(a, b, p);
            if (inside(wa, b, c) && inside(wb, c, a) && inside(wc, a, b)) {
                const float la = static_cast<float>(wa) / area;
                const float lb = static_cast<float>(wb) / area;
                const float lc = static_cast<float>(wc) / area;
                if (swapped)
                    visit(x, y, la, lc, lb);
                else
                    visit(x, y, la, lb, lc);
            }
        }
    }
}

Image<int> count_coverage(const std::vector<Triangle>& triangles, int width, int height) {
    Image<int> count(width, height, 0);
    for (const Triangle& triangle : triangles)
        visit_pixels(triangle, width, height, [&](int x, int y, float, float, float) { count(x, y) += 1; });
    return count;
}

ImageRgb draw(const std::vector<Triangle>& triangles, int width, int height, Rgb background) {
    ImageRgb image(width, height, background);
    for (const Triangle& t : triangles)
        visit_pixels(t, width, height, [&](int x, int y, float a, float b, float c) {
            image(x, y) = t.colors[0] * a + t.colors[1] * b + t.colors[2] * c;
        });
    return image;
}

} // namespace duet::lab
