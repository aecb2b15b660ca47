// Lab 03: the z-buffer.
#pragma once

#include "common/image/image.h"
#include "tests/grading/lab.h"

#include <array>
#include <vector>

namespace duet::lab {

/// A triangle with a color at each corner. A corner's x and y are in pixels, and its z is the depth, from 0 (near) to 1
/// (far). Corners are clockwise or counter-clockwise, and may lie outside of the image.
struct Triangle {
    std::array<Vec3, 3> corners;
    std::array<Rgb, 3> colors;
};

/// The depth at a point of a triangle: the mean of its corners' depths, with the weights of the point (they sum to 1).
float depth_at(const Triangle& triangle, Vec3 weights);

/// Whether a pixel of depth z is drawn where the depth buffer holds `stored`: only if z is nearer. Not if both are
/// equal, and not if z isn't a number (NaN).
bool passes(float z, float stored);

/// The number of the level that is nearest to a depth, if there are 2^bits levels, evenly from 0 (depth 0) to
/// 2^bits - 1 (depth 1). Depths below 0 count as 0, depths above 1 as 1. bits is from 1 to 20.
int quantize(float z, int bits);

/// What one sees of the triangles on the background: in each pixel the nearest one that covers its center. Of several
/// at the same depth it is the one that comes first in the list. Its color is the mean of the corners' colors by the
/// weights of the pixel's center. for_each_pixel of lesson 02 finds the pixels and the weights.
ImageRgb draw(const std::vector<Triangle>& triangles, int width, int height, Rgb background);

/// The same with depths that are rounded to 2^bits levels before they are compared.
ImageRgb draw_quantized(const std::vector<Triangle>& triangles, int width, int height, Rgb background, int bits);

/// One image for each list of triangles, with one depth buffer for all of them. Each image is as `draw` would have made
/// it.
std::vector<ImageRgb> draw_frames(const std::vector<std::vector<Triangle>>& frames, int width, int height,
                                  Rgb background);

} // namespace duet::lab

DUET_LAB(depth_at, passes, quantize, draw, draw_quantized, draw_frames)
