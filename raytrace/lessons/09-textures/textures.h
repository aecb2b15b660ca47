// Colors that change over a surface: from an image, by a rule, and from noise.
#pragma once

#include "common/image/image.h"
#include <cmath>
#include <cstdint>

namespace duet::lesson {

/// Where a unit normal of a sphere lies on a map of it: (u, v), from 0 to 1. u grows to the east: to the right, seen
/// from outside with +y up. (1/2, 1/2) is at +z. v is 0 at the south pole, -y, and 1 at the north pole, +y.
inline Vec2 sphere_uv(Vec3 n) {
    return {0.5f + std::atan2(n.x, n.z) / (2 * kPi), 0.5f + std::asin(clamp(n.y, -1.0f, 1.0f)) / kPi};
}
/// The unit normal at a point of the map.
inline Vec3 sphere_normal(Vec2 uv) {
    const float longitude = (uv.x - 0.5f) * 2 * kPi, latitude = (uv.y - 0.5f) * kPi, ring = std::cos(latitude);
    return {ring * std::sin(longitude), std::sin(latitude), ring * std::cos(longitude)};
}

/// The color of the texel that (u, v) lies in. (0, 0) is the image's lower left corner. The image repeats to the left
/// and to the right; above and below, its edge goes on.
inline Rgb image_color(const ImageRgb& image, Vec2 uv) {
    const float u = uv.x - std::floor(uv.x), v = clamp(uv.y, 0.0f, 1.0f);
    const int column = static_cast<int>(u * static_cast<float>(image.width()));
    const int row = static_cast<int>((1 - v) * static_cast<float>(image.height())); // row 0 is the top row
    return image(min(column, image.width() - 1), min(row, image.height() - 1));
}

/// Whether a point is in a dark cube, where cubes of side 1 are light and dark in turn along each axis.
inline bool checker(Vec3 p) { return std::fmod(std::floor(p.x) + std::floor(p.y) + std::floor(p.z), 2.0f) != 0; }

/// Random bits that depend on a point with whole coordinates alone.
inline std::uint32_t hash(Vec3 point) {
    std::uint32_t bits = 0x2545f491u;
    for (const float x : {point.x, point.y, point.z})
        bits = (bits ^ bits >> 15 ^ static_cast<std::uint32_t>(static_cast<int>(x))) * 0x9e3779b1u;
    return (bits ^ bits >> 15) * 0x85ebca6bu;
}
/// The dot product of d with a random gradient of the corner c: one of the 12 along the diagonals of a cube's faces.
inline float corner_slope(Vec3 c, Vec3 d) {
    const std::uint32_t bits = hash(c) >> 8, flat = bits % 3; // the axis along which the gradient is 0
    const float a = d[(flat + 1) % 3], b = d[(flat + 2) % 3];
    return ((bits & 0x1000) == 0 ? a : -a) + ((bits & 0x2000) == 0 ? b : -b);
}

/// From 0 to 1, and flat at both ends. (Perlin 2002)
inline float fade(float t) { return t * t * t * (t * (t * 6 - 15) + 10); }
/// A function of p from the corners c of the unit cube around it. Each gives the value corner(c, p - c), which counts
/// by how near it is: fully at the corner itself, not at all at the other side of the cube.
template <typename Corner, typename Fade> float lattice_noise(Vec3 p, const Corner& corner, const Fade& weight) {
    const Vec3 base{std::floor(p.x), std::floor(p.y), std::floor(p.z)};
    float sum = 0;
    for (int i = 0; i < 8; ++i) {
        const Vec3 c = base + Vec3(Vec3T<int>(i & 1, i >> 1 & 1, i >> 2));
        const Vec3 d = p - c, near = Vec3(1, 1, 1) - abs(d);
        sum += weight(near.x) * weight(near.y) * weight(near.z) * corner(c, d);
    }
    return sum;
}
/// Gradient noise: 0 at each point with whole coordinates, and smooth. (Perlin 1985, 2002)
inline float gradient_noise(Vec3 p) { return lattice_noise(p, corner_slope, fade); }
/// A noise, and the same again at half the size and half the height, and so on.
inline float fractal_noise(Vec3 p, int octaves) {
    return octaves == 0 ? 0 : gradient_noise(p) + fractal_noise(p * 2.0f, octaves - 1) / 2;
}

} // namespace duet::lesson
