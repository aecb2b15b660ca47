// Your z-buffer. Write the functions from the top down: each needs those before it.
#include "raster/lessons/02-triangles/triangle.h"
#include "raster/lessons/03-z-buffer/lab.h"

namespace duet::lab {

float depth_at(const Triangle& triangle, Vec3 weights) {
    not_attempted(); // Remove this line when you start.
    (void)triangle, (void)weights;
    // The weight weights.x belongs to triangle.corners[0], and so on.
    return 0;
}

bool passes(float z, float stored) {
    not_attempted(); // Remove this line when you start.
    (void)z, (void)stored;
    // Nearer means less depth. Every comparison with NaN is false.
    return false;
}

int quantize(float z, int bits) {
    not_attempted(); // Remove this line when you start.
    (void)z, (void)bits;
    // How many levels are there? What is the number of the last one?
    return 0;
}

ImageRgb draw(const std::vector<Triangle>& triangles, int width, int height, Rgb background) {
    not_attempted(); // Remove this line when you start.
    // For now each triangle is drawn over those before, whatever its depth.
    ImageRgb image(width, height, background);
    for (const Triangle& t : triangles)
        lesson::for_each_pixel({t.corners[0].x, t.corners[0].y}, {t.corners[1].x, t.corners[1].y},
                               {t.corners[2].x, t.corners[2].y}, width, height, [&](int x, int y, Vec3 w) {
                                   image(x, y) = t.colors[0] * w.x + t.colors[1] * w.y + t.colors[2] * w.z;
                               });
    return image;
}

ImageRgb draw_quantized(const std::vector<Triangle>& triangles, int width, int height, Rgb background, int bits) {
    not_attempted(); // Remove this line when you start.
    (void)triangles, (void)bits;
    return ImageRgb(width, height, background);
}

std::vector<ImageRgb> draw_frames(const std::vector<std::vector<Triangle>>& frames, int width, int height,
                                  Rgb background) {
    not_attempted(); // Remove this line when you start.
    // What must happen to the depth buffer before each image?
    return std::vector<ImageRgb>(frames.size(), ImageRgb(width, height, background));
}

} // namespace duet::lab
