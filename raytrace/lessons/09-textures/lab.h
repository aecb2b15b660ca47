// Lab 09: textures.
#pragma once

#include "common/image/image.h"
#include "tests/grading/lab.h"

#include <array>
#include <cstdint>

namespace duet::lab {

/// Where a unit normal of a sphere lies on a map of it: u = 1/2 at +z, growing to the right for who looks at the sphere
/// from outside, with +y up; so +x is at u = 3/4. v grows evenly with the latitude: 0 at -y, 1/2 at the equator, 1 at
/// +y. Both are from 0 to 1. At the poles any such u will do. Rounding may have made a coordinate of n slightly larger
/// than 1: the result is finite all the same.
Vec2 sphere_uv(Vec3 n);

/// The color of the texel that (u, v) lies in. (0, 0) is the lower left corner of the image, (1, 1) its upper right
/// one. To the left and right, the image repeats. Below it and above it, its lowest and its highest row go on. Row 0 of
/// an image is its top row. u and v are within ±1000.
Rgb image_color(const ImageRgb& image, Vec2 uv);

/// Whether p is in a dark cube. All cubes have the side 1, and their corners at whole coordinates. The cube from (0, 0,
/// 0) to (1, 1, 1) is light, and any two that share a face are different. Coordinates are within ±1000.
bool checker(Vec3 p);

/// The weight of a corner, from how near it is: 6t⁵ - 15t⁴ + 10t³, for t from 0 to 1.
float fade(float t);

/// Given: the gradient of the corner (x, y, z) of the lattice, one of twelve.
inline Vec3 gradient(int x, int y, int z) {
    constexpr std::array<std::array<float, 3>, 12> kGradients{{{1, 1, 0},
                                                               {-1, 1, 0},
                                                               {1, -1, 0},
                                                               {-1, -1, 0},
                                                               {1, 0, 1},
                                                               {-1, 0, 1},
                                                               {1, 0, -1},
                                                               {-1, 0, -1},
                                                               {0, 1, 1},
                                                               {0, -1, 1},
                                                               {0, 1, -1},
                                                               {0, -1, -1}}};
    std::uint32_t bits = static_cast<std::uint32_t>(x) * 0x8da6b343u ^ static_cast<std::uint32_t>(y) * 0xd8163841u ^
                         static_cast<std::uint32_t>(z) * 0xcb1ab31fu;
    bits = (bits ^ bits >> 15) * 0x85ebca6bu;
    const auto& g = kGradients[(bits ^ bits >> 13) % 12];
    return {g[0], g[1], g[2]};
}

/// Gradient noise: the sum, over the eight corners c of the unit cube around p, of the dot product of gradient(c) with
/// p - c, times fade(1 - |p - c|) along each of the three axes. It is not scaled. Coordinates are within ±1000.
float gradient_noise(Vec3 p);

/// The sum of |gradient_noise(2^i p)| / 2^i for i from 0 to octaves - 1; 0 if octaves is 0. octaves <= 8.
float turbulence(Vec3 p, int octaves);

} // namespace duet::lab

DUET_LAB(sphere_uv, image_color, checker, fade, gradient_noise, turbulence)
