// Matte surfaces.
#include "raytrace/lessons/05-diffuse/lab.h"

namespace duet::lab {

float srgb_from_linear(float linear) {
    if (linear <= 0.0031308f) return 12.92f * linear;
    return 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

std::optional<Vec3> unit_vector(Vec3 cube_point) {
    const float squared = length_squared(cube_point);
    if (squared > 1 || squared < 1e-12f) return std::nullopt;
    return cube_point / std::sqrt(squared);
}

Vec3 diffuse_direction(Vec3 n, Vec3 u) {
    const Vec3 d = n + u;
    if (length_squared(d) < 1e-12f) return n;
    return d;
}

Vec3 offset_origin(Vec3 p, Vec3 p_error, Vec3 n, Vec3 direction) {
    const Vec3 toward = dot(direction, n) < 0 ? -n : n;
    return p + toward * (1.1f * dot(abs(n), p_error));
}

Rgb path_color(const std::vector<Sphere>& spheres, const std::vector<Rgb>& albedos, const Ray& ray, int bounces,
               int seed) {
    lesson::Random random(static_cast<std::uint64_t>(seed));
    Rgb weight(1);
    Ray next = ray;
    for (int met = 0; met <= bounces; ++met) {
        const auto hit = lesson::closest_hit(spheres, next);
        if (!hit) return weight * lesson::sky_color(next.direction);
        weight *= albedos[hit->index];
        std::optional<Vec3> u;
        while (!u) {
            const float x = 2 * random.next() - 1, y = 2 * random.next() - 1, z = 2 * random.next() - 1;
            u = unit_vector({x, y, z});
        }
        next = Ray{hit->p, diffuse_direction(hit->n, *u), 0.001f};
    }
    return Rgb(0);
}

} // namespace duet::lab
