// A picture that knows how far away each of its pixels is.
#pragma once

#include "common/image/image.h"
#include "raster/lessons/02-triangles/triangle.h"

namespace duet::lesson {

struct Framebuffer {
    ImageRgb color;
    ImageFloat depth; ///< of what is seen so far: smaller is nearer, infinity where nothing is

    Framebuffer(int width, int height, Rgb background)
        : color(width, height, background), depth(width, height, kInfinity) {}

    /// Writes the pixel if nothing nearer was written there before. (Catmull 1974, "A Subdivision Algorithm for Computer
    /// Display of Curved Surfaces", whose z-buffer this is)
    void write(int x, int y, float z, Rgb value) {
        if (!(z < depth(x, y))) return;
        depth(x, y) = z;
        color(x, y) = value;
    }
};

} // namespace duet::lesson
