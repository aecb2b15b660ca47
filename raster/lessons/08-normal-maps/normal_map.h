// Relief by an image of normals.
#pragma once

#include "raster/lessons/05-clipping/clip.h"
#include "raster/lessons/07-textures/texture.h"

namespace duet::lesson {

/// Two directions on a surface, of unit length and at right angles to its normal: along u and along v.
struct TangentFrame {
    Vec3 t, b;
};

/// The frame of a triangle at a point with the unit normal n. Both are 0 where the corners' uv lie on one line.
inline TangentFrame tangent_frame(const Triangle& triangle, Vec3 n) {
    const auto& [p, q, r] = triangle;
    const Vec3 e1 = q.p - p.p, e2 = r.p - p.p;
    const Vec2 d1 = q.uv - p.uv, d2 = r.uv - p.uv;
    const float det = d1.x * d2.y - d1.y * d2.x;
    if (det == 0) return {};
    const Vec3 along_u = (e1 * d2.y - e2 * d1.y) / det, along_v = (e2 * d1.x - e1 * d2.x) / det;
    const Vec3 t = normalize(along_u - n * dot(n, along_u)), b = cross(n, t);
    return {t, dot(b, along_v) < 0 ? -b : b}; // where the texture is mirrored, t, b and n are left-handed
}

/// The normal that a texel of a normal map stands for, in the frame of the surface: components from -1 to 1.
inline Vec3 decode_normal(Rgb texel) { return {2 * texel.r - 1, 2 * texel.g - 1, 2 * texel.b - 1}; }

/// The unit normal in the world, from that of the map.
inline Vec3 perturb(Vec3 n, const TangentFrame& frame, Vec3 mapped) {
    return normalize(frame.t * mapped.x + frame.b * mapped.y + n * mapped.z);
}

/// The normal map of a relief. Heights are in widths of a texel. The map repeats beyond its edges.
inline ImageRgb normal_map(const ImageFloat& heights) {
    ImageRgb map(heights.width(), heights.height());
    for (int j = 0; j < map.height(); ++j)
        for (int i = 0; i < map.width(); ++i) {
            const float slope_x = (texel(heights, i + 1, j) - texel(heights, i - 1, j)) / 2;
            const float slope_y = (texel(heights, i, j + 1) - texel(heights, i, j - 1)) / 2;
            map(i, map.height() - 1 - j) = direction_color(normalize(Vec3{-slope_x, -slope_y, 1}));
        }
    return map;
}

} // namespace duet::lesson
