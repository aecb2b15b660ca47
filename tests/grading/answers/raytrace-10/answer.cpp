// Quads and the light that they send out.
#include "raytrace/lessons/10-cornell-box/lab.h"

namespace duet::lab {

std::optional<float> hit_quad(const Quad& quad, const Ray& ray) {
    const Vec3 n = cross(quad.u, quad.v);
    const float slope = dot(n, ray.direction);
    if (slope == 0) return std::nullopt;
    const float t = dot(n, quad.corner - ray.origin) / slope;
    if (t <= ray.t_min || t >= ray.t_max) return std::nullopt;
    const Vec3 d = ray.at(t) - quad.corner;
    const float a = dot(n, cross(d, quad.v)) / dot(n, n);
    const float b = dot(n, cross(quad.u, d)) / dot(n, n);
    if (a < 0 || a > 1) return std::nullopt;
    if (b < 0 || b > 1) return std::nullopt;
    return t;
}

std::vector<Quad> box_of_quads(Vec3 low, Vec3 high, Rgb albedo) {
    const Vec3 x{high.x - low.x, 0, 0};
    const Vec3 y{0, high.y - low.y, 0};
    const Vec3 z{0, 0, high.z - low.z};
    std::vector<Quad> sides;
    sides.push_back({low, z, y, albedo});
    sides.push_back({low + x, y, z, albedo});
    sides.push_back({low, x, z, albedo});
    sides.push_back({low + y, z, x, albedo});
    sides.push_back({low, y, x, albedo});
    sides.push_back({low + z, x, y, albedo});
    return sides;
}

Rgb emitted(const Quad& quad, Vec3 ray_direction) {
    if (dot(cross(quad.u, quad.v), ray_direction) < 0) return quad.emission;
    return Rgb(0);
}

std::optional<lesson::Hit> closest_hit(const std::vector<Quad>& quads, const Ray& ray) {
    Ray shorter = ray;
    std::optional<lesson::Hit> closest;
    for (std::size_t i = 0; i < quads.size(); ++i) {
        const auto t = hit_quad(quads[i], shorter);
        if (!t) continue;
        shorter.t_max = *t;
        closest = lesson::make_hit(ray, *t, normalize(cross(quads[i].u, quads[i].v)), i);
    }
    return closest;
}

Rgb path_color(const std::vector<Quad>& quads, const Ray& ray, int bounces, int seed) {
    lesson::Random random(static_cast<std::uint64_t>(seed));
    Rgb light(0), weight(1);
    Ray next = ray;
    for (int i = 0; i <= bounces; ++i) {
        const auto hit = closest_hit(quads, next);
        if (!hit) break;
        light += weight * emitted(quads[hit->index], next.direction);
        weight *= quads[hit->index].albedo;
        next = Ray{hit->p, lesson::random_diffuse_direction(hit->n, random), 0.001f};
    }
    return light;
}

} // namespace duet::lab
