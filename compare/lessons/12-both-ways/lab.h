// Lab 12: what two pipelines must agree on, and how far two images differ.
#pragma once

#include "common/image/image.h"
#include "common/vec/ray.h"
#include "tests/grading/lab.h"

#include <optional>
#include <vector>

namespace duet::lab {

/// A camera without a lens. It stands at eye and looks toward target; up is upward in the image, of any length, not
/// parallel to the view. x points right in the image and y down, both in pixels from the upper left corner.
struct Camera {
    Vec3 eye, target, up;
    float fov_degrees; ///< the vertical angle of view, between 1 and 170
};

/// The ray from the eye through the center of the pixel in column x and row y of a width × height image. Row 0 is the
/// top one, and pixels are squares. The direction has length 1, t_min is 0, t_max is infinite.
Ray pixel_ray(const Camera& camera, int width, int height, int x, int y);

/// Where the point p of the world is in the image: (x, y) in pixels from the upper left corner. It may be outside of
/// the image. Nothing where p is not in front of the eye. The inverse of pixel_ray: all points of the ray of pixel
/// (x, y) are at (x + 0.5, y + 0.5).
std::optional<Vec2> project(const Camera& camera, int width, int height, Vec3 p);

/// Differences d = a - b of an image a from a reference b, over all pixels and all three channels.
struct Errors {
    double mean = 0;   ///< the mean of d: positive where the image is too bright
    double mse = 0;    ///< the mean of d²
    double relmse = 0; ///< the mean of d² / (b² + 0.01)
};
/// Of images with the values that a PNG file has, from 0 to 1: encoded by the sRGB curve. a and b are linear. A value e
/// is decoded to e / 12.92 where e <= 0.04045, and else to ((e + 0.055) / 1.055) to the power of 2.4. Sum in double.
Errors errors(const ImageRgb& encoded_image, const ImageRgb& encoded_reference);

/// What one way to draw found at a pixel.
struct PixelResult {
    int triangle; ///< the index of the triangle that is seen; -1 where there is none
    float sun;    ///< the fraction of the sun's light that arrives there, 0 to 1
    Rgb color;    ///< linear
};
enum class Cause { kSame, kEdge, kShadow, kLight };
/// Why two ways differ at a pixel. The first line that fits counts:
/// kSame: no channel of the colors differs by more than the tolerance.
/// kEdge: they see different triangles, or only one of them sees any.
/// kShadow: the fractions of the sun's light differ by more than the tolerance.
/// kLight: all else.
Cause classify_pixel(const PixelResult& first, const PixelResult& second, float tolerance);

/// How the squared errors of a random method come about.
struct ErrorComponents {
    double noise = 0; ///< the variance of a value of one image
    double squared_bias = 0; ///< the squared bias: how far the mean of endlessly many images is from the reference
};
/// From n >= 2 images of one scene, made with different random numbers, all as large as the reference; linear. For each
/// value (a channel of a pixel) let m be its mean over the images. Then its noise is the sum of (a - m)² over the
/// images, divided by n - 1, and its squared bias is (m - b)² - noise / n. (The part that is subtracted is what the
/// noise of m itself makes of (m - b)²; so the result may be slightly negative.) Returns the means over all values. In
/// double.
ErrorComponents split_error(const std::vector<ImageRgb>& images, const ImageRgb& reference);

} // namespace duet::lab

DUET_LAB(pixel_ray, project, errors, classify_pixel, split_error)
