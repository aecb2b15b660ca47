// Your comparison. Write the functions from the top down; each of the last three stands alone.
#include "compare/lessons/12-both-ways/lab.h"

#include <cmath>

namespace duet::lab {

Ray pixel_ray(const Camera& camera, int width, int height, int x, int y) {
    not_attempted(); // Remove this line when you start.
    (void)width, (void)height, (void)x, (void)y;
    // First find the camera's axes: right, up and forward, each of length 1. Then: how far right and up of the middle
    // of the image is the pixel's center, if the image stands at the distance 1 before the eye? For now all pixels look
    // at the target.
    return {camera.eye, normalize(camera.target - camera.eye), 0, kInfinity};
}

std::optional<Vec2> project(const Camera& camera, int width, int height, Vec3 p) {
    not_attempted(); // Remove this line when you start.
    (void)camera, (void)p;
    // Take the same axes. How far right, up and forward of the eye is p? Divide, and scale to pixels.
    return Vec2{static_cast<float>(width) / 2, static_cast<float>(height) / 2};
}

Errors errors(const ImageRgb& encoded_image, const ImageRgb& encoded_reference) {
    not_attempted(); // Remove this line when you start.
    (void)encoded_image, (void)encoded_reference;
    // Decode each value first. image[i] is the pixel i, image[i][c] its channel c, and image.size() the number of
    // pixels.
    return {};
}

Cause classify_pixel(const PixelResult& first, const PixelResult& second, float tolerance) {
    not_attempted(); // Remove this line when you start.
    (void)first, (void)second, (void)tolerance;
    // The order of the questions matters.
    return Cause::kSame;
}

ErrorComponents split_error(const std::vector<ImageRgb>& images, const ImageRgb& reference) {
    not_attempted(); // Remove this line when you start.
    (void)images, (void)reference;
    // For each value two passes over the images: the first for the mean, the second for the squares about it.
    return {};
}

} // namespace duet::lab
