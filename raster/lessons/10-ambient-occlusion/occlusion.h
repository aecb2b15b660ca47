// Ambient occlusion: how much of the sky each visible point sees, found in the depths of the image itself.
#pragma once

#include "raster/lessons/07-textures/pipeline.h"

namespace duet::lesson {

/// What each pixel shows: the point, its normal, and its distance in front of the eye (infinity where nothing is).
struct GBuffer {
    Mat4 clip_from_world;
    Image<Vec3> p, n;
    ImageFloat distance;
};
inline GBuffer draw_gbuffer(const Mesh& world, const Mat4& clip_from_world, int width, int height) {
    GBuffer seen{clip_from_world, {width, height}, {width, height}, {width, height, kInfinity}};
    Framebuffer target(width, height, Rgb(0));
    draw_triangles(target, in_clip_space(world, clip_from_world), [&](const Fragment& f) {
        seen.p(f.x, f.y) = f.p, seen.n(f.x, f.y) = f.n, seen.distance(f.x, f.y) = (clip_from_world * Vec4(f.p, 1)).w;
        return Rgb(0);
    });
    return seen;
}

/// Direction i of `count` in the hemisphere about n, dense like the cosine, turned by a part of a revolution.
inline Vec3 hemisphere_direction(Vec3 n, int i, int count, float turn) {
    const float squared = (static_cast<float>(i) + 0.5f) / static_cast<float>(count), r = std::sqrt(squared);
    const float angle = 2 * kPi * (0.618034f * static_cast<float>(i) + turn);
    const Vec3 u = normalize(cross(n, std::abs(n.x) < 0.8f ? Vec3{1, 0, 0} : Vec3{0, 1, 0})), v = cross(n, u);
    return u * (r * std::cos(angle)) + v * (r * std::sin(angle)) + n * std::sqrt(1 - squared);
}

/// How to look for what hides the sky. Lengths are in meters. With one set, all pixels take the same directions.
struct Search {
    int directions = 16, sets = 16, blur = 4;
    float radius = 0.4f, bias = 0.005f, range = 0.4f;
};

/// Whether the point q is behind what the image shows there, by more than the bias and less than the range.
inline bool is_hidden(const GBuffer& seen, Vec3 q, const Search& search) {
    const int width = seen.distance.width(), height = seen.distance.height();
    const Vec4 at = to_image(seen.clip_from_world * Vec4(q, 1), width, height);
    const int x = static_cast<int>(std::floor(at.x)), y = static_cast<int>(std::floor(at.y));
    if (at.w <= 0 || x < 0 || y < 0 || x >= width || y >= height) return false; // the image doesn't know
    return at.w > seen.distance(x, y) + search.bias && at.w < seen.distance(x, y) + search.range;
}

/// The fraction of directions in which one of four points is hidden. The sets fill each block of 4 × 4 pixels.
inline float occlusion(const GBuffer& seen, int x, int y, const Search& search) {
    const float turn = static_cast<float>((x % 4 * 4 + y % 4 * 9) % search.sets) / 16;
    float hidden = 0;
    for (int i = 0; i < search.directions; ++i) {
        const Vec3 d = hemisphere_direction(seen.n(x, y), i, search.directions, turn) * search.radius;
        bool found = false;
        for (int k = 0; k < 4 && !found; ++k)
            found = is_hidden(seen, seen.p(x, y) + d * sqr((static_cast<float>(k) + 1 - 0.9f * turn) / 4), search);
        hidden += found;
    }
    return hidden / static_cast<float>(search.directions);
}

/// The light of the sky, white where nothing is hidden: the mean of blur × blur pixels that are about as far away.
inline ImageRgb sky_light(const GBuffer& seen, const Search& search) {
    const int width = seen.p.width(), height = seen.p.height(), size = search.blur;
    ImageFloat hidden(width, height);
    ImageRgb light(width, height);
    for (int i = 0; i < width * height; ++i)
        hidden(i % width, i / width) = occlusion(seen, i % width, i / width, search);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            float sum = 0, count = 0;
            for (int j = max(y - size / 2, 0); j < min(y - size / 2 + size, height); ++j)
                for (int i = max(x - size / 2, 0); i < min(x - size / 2 + size, width); ++i)
                    if (std::abs(seen.distance(i, j) - seen.distance(x, y)) < 0.03f) sum += hidden(i, j), ++count;
            light(x, y) = Rgb(1 - sum / count);
        }
    return light;
}

} // namespace duet::lesson
