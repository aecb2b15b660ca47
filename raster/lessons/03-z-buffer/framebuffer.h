// An image that knows how far away each of its pixels is.
#pragma once

#include "common/image/image.h"
#include "raster/lessons/02-triangles/triangle.h"

namespace duet::lesson {

struct Framebuffer {
    ImageRgb color;
    ImageFloat depth; ///< of what is seen so far: smaller is nearer, infinity where nothing is

    Framebuffer(int width, int height, Rgb background)
        : color(width, height, background), depth(width, height, kInfinity) {}

    /// Writes the pixel if nothing as near was written there before: the z-buffer of Catmull 1974.
    void write(int x, int y, float z, Rgb value) {
        if (!(z < depth(x, y))) return;
        depth(x, y) = z;
        color(x, y) = value;
    }
};

/// Smooth edges: of an image that was drawn n times too wide and high, each block of n × n pixels becomes their mean.
inline ImageRgb shrink(const ImageRgb& large, int n) {
    ImageRgb small(large.width() / n, large.height() / n);
    for (int y = 0; y < small.height() * n; ++y)
        for (int x = 0; x < small.width() * n; ++x) small(x / n, y / n) += large(x, y) / static_cast<float>(n * n);
    return small;
}

} // namespace duet::lesson
