// Your triangles. Write the functions from the top down: each needs those before it.
#include "raster/lessons/02-triangles/lab.h"

namespace duet::lab {

GridPoint snap(Vec2 p) {
    not_attempted(); // Remove this line when you start.
    (void)p;
    // Multiply by the number of steps a pixel, then round to the nearest whole number (there is std::lround).
    return {0, 0};
}

std::int64_t edge_function(GridPoint a, GridPoint b, GridPoint p) {
    not_attempted(); // Remove this line when you start.
    (void)a, (void)b, (void)p;
    // The formula is in the page. How many bits does the product of two differences need?
    return 0;
}

bool is_top_left(GridPoint a, GridPoint b) {
    not_attempted(); // Remove this line when you start.
    (void)a, (void)b;
    // Which way does a left edge of a clockwise triangle run? Which way does a top edge?
    return false;
}

Image<int> count_coverage(const std::vector<Triangle>& triangles, int width, int height) {
    not_attempted(); // Remove this line when you start.
    (void)triangles;
    // Begin with one triangle whose corners are clockwise. Test the center of every pixel against its three edges.
    return Image<int>(width, height, 0);
}

ImageRgb draw(const std::vector<Triangle>& triangles, int width, int height, Rgb background) {
    not_attempted(); // Remove this line when you start.
    // For now each corner is one pixel. Fill the triangles instead.
    ImageRgb image(width, height, background);
    for (const Triangle& triangle : triangles)
        for (std::size_t i = 0; i < 3; ++i) {
            const int x = static_cast<int>(triangle.corners[i].x), y = static_cast<int>(triangle.corners[i].y);
            if (x >= 0 && x < width && y >= 0 && y < height) image(x, y) = triangle.colors[i];
        }
    return image;
}

} // namespace duet::lab
