// Shading, from the page of the lesson.
#include "raster/lessons/06-shading/lab.h"

#include <algorithm>
#include <cmath>

namespace duet::lab {

float lambert(Vec3 n, Vec3 to_light) {
    const Vec3 l = normalize(to_light);
    return std::max(0.0f, dot(n, l));
}

std::optional<Vec3> flat_normal(Vec3 a, Vec3 b, Vec3 c) {
    const Vec3 n = cross(b - a, c - a);
    if (n == Vec3{0, 0, 0}) return std::nullopt;
    return normalize(n);
}

Vec3 transform_normal(std::array<Vec3, 3> columns, Vec3 n) {
    const Vec3 a = columns[0], b = columns[1], c = columns[2];
    Vec3 result = cross(b, c) * n.x + cross(c, a) * n.y + cross(a, b) * n.z;
    if (dot(a, cross(b, c)) < 0) result = -result;
    return normalize(result);
}

Vec3 interpolated_normal(std::array<Vec3, 3> normals, Vec3 weights) {
    const Vec3 mean = normals[0] * weights.x + normals[1] * weights.y + normals[2] * weights.z;
    return normalize(mean);
}

Rgb blinn_phong(Vec3 p, Vec3 n, Vec3 light, Vec3 eye, Rgb diffuse, float specular, float shininess) {
    const Vec3 to_light = normalize(light - p);
    const Vec3 to_eye = normalize(eye - p);
    const float cosine = dot(n, to_light);
    if (cosine <= 0) return Rgb(0.0f);
    const Vec3 half = normalize(to_light + to_eye);
    const float highlight = std::pow(std::max(0.0f, dot(n, half)), shininess);
    return diffuse * cosine + Rgb(specular * highlight);
}

} // namespace duet::lab
