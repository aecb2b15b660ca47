// Lab 07: textures. It builds on triangle.h of lesson 02 (for_each_pixel) and transform.h of lesson 04 (to_image).
#pragma once

#include "common/image/image.h"
#include "raster/lessons/02-triangles/triangle.h"
#include "raster/lessons/04-camera/transform.h"
#include "tests/grading/lab.h"

#include <array>

namespace duet::lab {

/// The weights of a triangle's corners at a point of the triangle itself, from the weights in the image. The distances
/// w in front of the eye, one a corner, are positive. Both kinds of weights sum to 1.
Vec3 perspective_weights(Vec3 weights, Vec3 w);

/// The whole number from 0 to size - 1 that differs from i by a multiple of size. size > 0; i may be negative.
int wrap(int i, int size);

/// The color of the texel that contains the point uv. (0, 0) is the lower left corner of the image, (1, 1) its upper
/// right one. The image repeats beyond its edges. Row 0 of an image is its top row. uv are within ±1000.
Rgb nearest(const ImageRgb& image, Vec2 uv);

/// The mean of the four texels whose centers surround the point uv, weighted by how near they are. At the center of a
/// texel it is the color of that texel. The rest is as for nearest.
Rgb bilinear(const ImageRgb& image, Vec2 uv);

/// A corner of a quad: its point in clip space, with w > 0, and its place in the texture.
struct Corner {
    Vec4 clip;
    Vec2 uv;
};

/// A textured quad on a background of width × height pixels. It is drawn as the triangles of the corners 0, 1, 2 and 0,
/// 2, 3. Each pixel that they cover has the color of bilinear, at uv that are right in perspective. There is no light.
ImageRgb draw_quad(const std::array<Corner, 4>& corners, const ImageRgb& texture, int width, int height,
                   Rgb background);

} // namespace duet::lab

DUET_LAB(perspective_weights, wrap, nearest, bilinear, draw_quad)
