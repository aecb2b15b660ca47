// Shadow maps: what the sun sees is lit, and all behind it is in shadow.
#pragma once

#include "raster/lessons/07-textures/pipeline.h"

namespace duet::lesson {

/// World space to clip space of the sun: the cube around a sphere, with depth 0 toward the sun. to_sun has length 1.
inline Mat4 sun_matrix(Vec3 to_sun, Vec3 center, float radius) {
    const Vec3 up = std::abs(to_sun.y) < 0.9f ? Vec3{0, 1, 0} : Vec3{0, 0, 1}; // any but the sun's own direction
    return scaling(Vec3{1, 1, -0.5f} / radius) * look_at(center + to_sun * radius, center, up);
}

/// The depths that the sun sees in a cube of the world, whose sides have a length in meters.
struct ShadowMap {
    Mat4 clip_from_world;
    float size;
    ImageFloat depth; ///< at the center of each texel, from 0 to 1; infinity where nothing is
};

/// Draws the depths, onto side × side texels. (Williams 1978, "Casting Curved Shadows on Curved Surfaces")
inline ShadowMap draw_shadow_map(const Mesh& world, const Mat4& clip_from_world, float size, int side) {
    Framebuffer target(side, side, Rgb(0));
    draw_triangles(target, in_clip_space(world, clip_from_world), [](const Fragment&) { return Rgb(0); });
    return {clip_from_world, size, target.depth};
}

/// How much nearer to the sun a point is taken to be, in meters, so that its own surface doesn't shade it. n is the
/// normal. Texels' centers are up to reach + 1/2 texels away along x and y; corners were snapped by up to 1/512 more.
inline float slope_bias(const ShadowMap& map, Vec3 to_sun, Vec3 n, int reach) {
    const float cosine = clamp(dot(n, to_sun), 0.1f, 1.0f), slope = std::sqrt(1 - cosine * cosine) / cosine;
    const float texel = map.size / static_cast<float>(map.depth.width());
    return (static_cast<float>(reach) + 0.51f) * std::sqrt(2.0f) * texel * slope + 2e-6f * map.size;
}

/// The fraction of the sun's light that arrives at p: that of the (2 reach + 1)² texels around it in which the sun sees
/// nothing nearer. What the map doesn't hold is lit. (Percentage-closer filtering: Reeves, Salesin and Cook 1987)
inline float lit_fraction(const ShadowMap& map, Vec3 p, float bias, int reach) {
    const int side = map.depth.width();
    const Vec4 q = to_image(map.clip_from_world * Vec4(p, 1), side, side);
    const int column = static_cast<int>(std::floor(q.x)), row = static_cast<int>(std::floor(q.y));
    int lit = 0;
    for (int y = row - reach; y <= row + reach; ++y)
        for (int x = column - reach; x <= column + reach; ++x)
            lit += x < 0 || y < 0 || x >= side || y >= side || q.z - bias / map.size <= map.depth(x, y);
    return static_cast<float>(lit) / static_cast<float>(sqr(2 * reach + 1));
}

} // namespace duet::lesson
