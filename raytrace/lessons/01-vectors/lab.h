// Lab 01: vectors, colors and a file.
#pragma once

#include "common/image/image.h"
#include "common/image/srgb.h"
#include "tests/grading/lab.h"

#include <string>

namespace duet::lab {

/// A vector without operators: you write what they do, component by component.
struct Vector {
    float x = 0, y = 0, z = 0;
};

/// The dot product a·b.
float dot(Vector a, Vector b);

/// The cross product a × b, for right-handed axes: x × y = z.
Vector cross(Vector a, Vector b);

/// The unit vector of the same direction. The length of a is between 1e-6 and 1e6.
Vector normalize(Vector a);

/// The linear interpolation: a for t = 0, b for t = 1, and evenly between them for 0 < t < 1.
Vector lerp(Vector a, Vector b, float t);

/// One component of linear light as the number of a file: encoded by srgb_encode (common/image/srgb.h, given), times
/// 255, rounded to the nearest whole number. Light below 0 gives 0, and light above 1 gives 255.
int to_byte(float linear);

/// The image as a PPM file of the kind P3, with the largest number 255. Numbers stand apart by blanks or line ends.
/// `image(column, row)` is a pixel; row 0 is the top row, and a file begins with it.
std::string ppm_text(const ImageRgb& image);

/// The image as a PPM file of the kind P6, with the largest number 255. Each of the strings of this lab is the whole
/// file.
std::string ppm_binary(const ImageRgb& image);

} // namespace duet::lab

DUET_LAB(dot, cross, normalize, lerp, to_byte, ppm_text, ppm_binary)
