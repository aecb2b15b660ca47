// Shadow maps, one texel at a time.
#include "raster/lessons/09-shadow-maps/lab.h"

#include <cmath>

namespace duet::lab {

Mat4 sun_matrix(Vec3 to_sun, Vec3 center, float radius) {
    Vec3 helper{0, 1, 0};
    if (std::abs(to_sun.y) > 0.8f) helper = {1, 0, 0};
    const Vec3 right = normalize(cross(helper, to_sun));
    const Vec3 up = cross(to_sun, right);
    Mat4 m;
    m[0] = {right.x / radius, right.y / radius, right.z / radius, -dot(right, center) / radius};
    m[1] = {up.x / radius, up.y / radius, up.z / radius, -dot(up, center) / radius};
    const Vec3 away = to_sun * (-1 / (2 * radius));
    m[2] = {away.x, away.y, away.z, 0.5f - dot(away, center)};
    return m;
}

/// Column and row as fractions, and the depth.
Vec3 find_place(const ShadowMap& map, Vec3 p) {
    const Vec3 clip = transform_point(map.clip_from_world, p);
    const float side = static_cast<float>(map.depth.width());
    const float x = (clip.x + 1) / 2 * side;
    const float y = (1 - clip.y) / 2 * side;
    return {x, y, clip.z};
}

bool texel_is_dark(const ShadowMap& map, int x, int y, float depth) {
    const int side = map.depth.width();
    if (x < 0 || y < 0 || x >= side || y >= side) return false;
    return depth > map.depth(x, y);
}

bool in_shadow(const ShadowMap& map, Vec3 p, float bias) {
    const Vec3 place = find_place(map, p);
    const int x = static_cast<int>(std::floor(place.x));
    const int y = static_cast<int>(std::floor(place.y));
    return texel_is_dark(map, x, y, place.z - bias / map.size);
}

float slope_bias(float texel, Vec3 to_sun, Vec3 n, int reach) {
    const float cosine = clamp(dot(n, to_sun), 0.1f, 1.0f);
    const float tangent = std::sqrt(1 - cosine * cosine) / cosine;
    const float away = static_cast<float>(reach) + 0.5f;
    return away * std::sqrt(2.0f) * texel * tangent;
}

float lit_fraction(const ShadowMap& map, Vec3 p, float bias, int reach) {
    const Vec3 place = find_place(map, p);
    const int column = static_cast<int>(std::floor(place.x));
    const int row = static_cast<int>(std::floor(place.y));
    int lit = 0, all = 0;
    for (int y = row - reach; y <= row + reach; ++y) {
        for (int x = column - reach; x <= column + reach; ++x) {
            all += 1;
            if (!texel_is_dark(map, x, y, place.z - bias / map.size)) lit += 1;
        }
    }
    return static_cast<float>(lit) / static_cast<float>(all);
}

ImageFloat sunlight(const ShadowMap& map, Vec3 to_sun, const Image<Vec3>& points, const Image<Vec3>& normals,
                    int reach) {
    ImageFloat light(points.width(), points.height(), 0);
    const float texel = map.size / static_cast<float>(map.depth.width());
    for (int y = 0; y < light.height(); ++y) {
        for (int x = 0; x < light.width(); ++x) {
            const Vec3 n = normals(x, y);
            const float cosine = dot(n, to_sun);
            if (cosine <= 0) continue;
            const float bias = slope_bias(texel, to_sun, n, reach);
            light(x, y) = cosine * lit_fraction(map, points(x, y), bias, reach);
        }
    }
    return light;
}

} // namespace duet::lab
