// The whole pipeline: clipping, division, coverage, depth, and attributes that are right in perspective.
#pragma once

#include "raster/lessons/03-z-buffer/framebuffer.h"
#include "raster/lessons/05-clipping/fragments.h"
#include "raster/lessons/06-shading/shading.h"

namespace duet::lesson {

/// The weights of a triangle's corners on the triangle itself, from those in the image. What is linear in the image
/// is not an attribute but attribute / w; 1 / w is linear too. (Blinn 1992, "Hyperbolic Interpolation")
inline Vec3 perspective_weights(const Triangle& part, Vec3 weights) {
    const Vec3 over_w{weights.x / part[0].clip.w, weights.y / part[1].clip.w, weights.z / part[2].clip.w};
    return over_w / (over_w.x + over_w.y + over_w.z);
}

/// A visible pixel of a triangle: what a shader computes a color from.
struct Fragment {
    int x, y;                 ///< the pixel
    Vec3 p;                   ///< the point seen, in the world
    Vec3 n;                   ///< its normal, of unit length
    Vec2 uv;                  ///< where it is in the texture
    const Triangle& triangle; ///< the whole triangle, for what is the same all over it
};

/// Draws triangles in clip space into a framebuffer. shade(fragment) returns a color. It is called for each pixel where
/// nothing nearer was drawn before; so what it stores for (x, y) is in the end that of the visible surface.
template <typename Shade>
void draw_triangles(Framebuffer& target, const std::vector<Triangle>& triangles, const Shade& shade) {
    for (const Triangle& triangle : triangles)
        for (const Triangle& part : clip_near(triangle))
            for_each_fragment(part, target.color.width(), target.color.height(), [&](int x, int y, float z, Vec3 w) {
                if (!(z < target.depth(x, y))) return; // it is hidden: spare the shading
                w = perspective_weights(part, w);
                const auto& [a, b, c] = part;
                const Vec3 p = a.p * w.x + b.p * w.y + c.p * w.z, n = a.n * w.x + b.n * w.y + c.n * w.z;
                const Vec2 uv = a.uv * w.x + b.uv * w.y + c.uv * w.z;
                target.write(x, y, z, shade(Fragment{x, y, p, normalize(n), uv, triangle}));
            });
}

} // namespace duet::lesson
