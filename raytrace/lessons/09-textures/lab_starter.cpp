// Lab 09: textures. The functions of the globe, the checkerboard and the noise don't depend on each other, but
// gradient_noise needs fade, and turbulence needs gradient_noise.
#include "raytrace/lessons/09-textures/lab.h"

#include <cmath>

namespace duet::lab {

Vec2 sphere_uv(Vec3 n) {
    not_attempted(); // Remove this line when you start.
    // This is a view from +z, as if the sphere were flat. Which function gives the angle of a point (x, z)?
    return {0.5f + 0.5f * n.x, 0.5f + 0.5f * n.y};
}

Rgb image_color(const ImageRgb& image, Vec2 uv) {
    not_attempted(); // Remove this line when you start.
    (void)image;
    return {uv.x, uv.y, 0.5f}; // The coordinates as a color, so far. Which column and which row is it?
}

bool checker(Vec3 p) {
    not_attempted(); // Remove this line when you start.
    return p.x > 0;  // Two halves, so far.
}

float fade(float t) {
    not_attempted(); // Remove this line when you start.
    return t;
}

float gradient_noise(Vec3 p) {
    not_attempted(); // Remove this line when you start.
    // This is the part of one corner alone. Eight count, each by how near it is.
    const Vec3 corner{std::floor(p.x), std::floor(p.y), std::floor(p.z)};
    return dot(gradient(static_cast<int>(corner.x), static_cast<int>(corner.y), static_cast<int>(corner.z)),
               p - corner);
}

float turbulence(Vec3 p, int octaves) {
    not_attempted(); // Remove this line when you start.
    (void)octaves;
    return std::abs(gradient_noise(p)); // One octave, so far.
}

} // namespace duet::lab
