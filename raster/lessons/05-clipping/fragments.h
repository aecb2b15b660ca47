// From a triangle in clip space to its pixels.
#pragma once

#include "raster/lessons/02-triangles/triangle.h"
#include "raster/lessons/05-clipping/clip.h"

namespace duet::lesson {

/// Calls visit(x, y, depth, part, weights) for each pixel of a width × height picture whose center the triangle covers.
/// All of it must be in front of the near plane. Weights are those of its corners in the picture; depth is linear
/// there, so they serve for it as they are.
template <typename Visit>
void for_each_fragment_of_part(const Triangle& part, int width, int height, const Visit& visit) {
    const Vec4 a = to_picture(part[0].clip, width, height), b = to_picture(part[1].clip, width, height),
               c = to_picture(part[2].clip, width, height);
    for_each_pixel({a.x, a.y}, {b.x, b.y}, {c.x, c.y}, width, height, [&](int x, int y, Vec3 weights) {
        visit(x, y, dot(weights, Vec3{a.z, b.z, c.z}), part, weights);
    });
}

/// The same for any triangle. part is the piece of it that has the pixel.
template <typename Visit> void for_each_fragment(const Triangle& triangle, int width, int height, const Visit& visit) {
    for (const Triangle& part : clip_near(triangle)) for_each_fragment_of_part(part, width, height, visit);
}

} // namespace duet::lesson
