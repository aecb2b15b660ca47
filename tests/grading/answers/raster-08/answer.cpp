// Normal maps, from the page of the lesson.
#include "raster/lessons/08-normal-maps/lab.h"

#include <cmath>

namespace duet::lab {

std::optional<Tangents> tangents(std::array<Vec3, 3> p, std::array<Vec2, 3> uv) {
    const Vec3 e1 = p[1] - p[0], e2 = p[2] - p[0];
    const float du1 = uv[1].x - uv[0].x, dv1 = uv[1].y - uv[0].y;
    const float du2 = uv[2].x - uv[0].x, dv2 = uv[2].y - uv[0].y;
    const float determinant = du1 * dv2 - dv1 * du2;
    if (determinant == 0) return std::nullopt;
    const Vec3 u = e1 * dv2 - e2 * dv1;
    const Vec3 v = e2 * du1 - e1 * du2;
    return Tangents{u / determinant, v / determinant};
}

TangentFrame tangent_frame(Vec3 n, Tangents tangents) {
    const Vec3 across = tangents.along_u - n * dot(n, tangents.along_u);
    const Vec3 t = normalize(across);
    Vec3 b = cross(n, t);
    if (dot(b, tangents.along_v) < 0) b = -b;
    return {t, b};
}

Vec3 decode_normal(Rgb texel) {
    const Vec3 color{texel.r, texel.g, texel.b};
    return color * 2.0f - Vec3{1, 1, 1};
}

Vec3 perturb(Vec3 n, TangentFrame frame, Vec3 mapped) {
    const Vec3 sum = frame.t * mapped.x + frame.b * mapped.y + n * mapped.z;
    return normalize(sum);
}

ImageRgb normal_map(const ImageFloat& heights) {
    const int width = heights.width(), height = heights.height();
    ImageRgb map(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const int left = (x + width - 1) % width, right = (x + 1) % width;
            const int above = (y + height - 1) % height, below = (y + 1) % height;
            const float slope_u = (heights(right, y) - heights(left, y)) * 0.5f;
            const float slope_v = (heights(x, above) - heights(x, below)) * 0.5f;
            const Vec3 n = normalize(Vec3{-slope_u, -slope_v, 1});
            map(x, y) = Rgb(n.x * 0.5f + 0.5f, n.y * 0.5f + 0.5f, n.z * 0.5f + 0.5f);
        }
    }
    return map;
}

} // namespace duet::lab
