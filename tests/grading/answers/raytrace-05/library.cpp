// The library's curve (common/image/srgb.h) and offset (common/geometry/surface_point.h); paths as in lesson 06.
#include "common/geometry/surface_point.h"
#include "common/image/srgb.h"
#include "raytrace/lessons/05-diffuse/lab.h"
#include "raytrace/lessons/06-metal-and-glass/materials.h"

namespace duet::lab {

float srgb_from_linear(float linear) { return srgb_encode(linear); }

std::optional<Vec3> unit_vector(Vec3 cube_point) {
    const float squared = length_squared(cube_point);
    return squared > 1e-12f && squared <= 1 ? std::optional(normalize(cube_point)) : std::nullopt;
}

Vec3 diffuse_direction(Vec3 n, Vec3 u) { return length_squared(n + u) > 1e-12f ? n + u : n; }

Vec3 offset_origin(Vec3 p, Vec3 p_error, Vec3 n, Vec3 direction) {
    return duet::offset_origin(p, p_error, dot(direction, n) < 0 ? -n : n);
}

Rgb path_color(const std::vector<Sphere>& spheres, const std::vector<Rgb>& albedos, const Ray& ray, int bounces,
               int seed) {
    std::vector<lesson::Material> materials;
    for (const Rgb& albedo : albedos) materials.push_back(lesson::matte(albedo));
    lesson::Random random(static_cast<std::uint64_t>(seed));
    const auto closest = [&](const Ray& next) { return lesson::closest_hit(spheres, next); };
    return lesson::path_color(closest, materials, ray, bounces, random);
}

} // namespace duet::lab
