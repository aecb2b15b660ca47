// From a triangle in clip space to its pixels.
#pragma once

#include "raster/lessons/02-triangles/triangle.h"
#include "raster/lessons/05-clipping/clip.h"

namespace duet::lesson {

/// Calls visit(x, y, depth, weights) for each pixel of a width × height image whose center the triangle covers. All of
/// it must be in front of the near plane. Depth is linear in the image, so the weights serve for it.
template <typename Visit> void for_each_fragment(const Triangle& part, int width, int height, const Visit& visit) {
    const auto corner = [&](std::size_t i) { return to_image(part[i].clip, width, height); };
    const Vec4 a = corner(0), b = corner(1), c = corner(2);
    for_each_pixel({a.x, a.y}, {b.x, b.y}, {c.x, c.y}, width, height, [&](int x, int y, Vec3 weights) {
        visit(x, y, dot(weights, Vec3{a.z, b.z, c.z}), weights);
    });
}

} // namespace duet::lesson
