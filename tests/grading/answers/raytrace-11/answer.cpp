// Densities, weights and direct light.
#include "raytrace/lessons/11-monte-carlo/lab.h"

namespace duet::lab {

float draw_power(float k, float u) { return std::pow(u, 1 / (k + 1)); }

Vec3 sample_quad(const Light& light, Vec2 random) { return light.corner + light.u * random.x + light.v * random.y; }

float light_density(const Light& light, Vec3 p, Vec3 q) {
    const Vec3 n = cross(light.u, light.v);
    const float area = length(n);
    const Vec3 d = p - q;
    const float distance = length(d);
    const float cosine = dot(n, d) / (area * distance);
    if (cosine <= 0) return 0;
    return distance * distance / (area * cosine);
}

float cosine_density(Vec3 n, Vec3 w) {
    const float cosine = dot(n, w);
    if (cosine < 0) return 0;
    return cosine / kPi;
}

Vec3 cosine_direction(Vec3 n, Vec2 random) {
    const float cosine = draw_power(1, random.x);
    const float sine = std::sqrt(1 - cosine * cosine);
    const float angle = 2 * kPi * random.y;
    Vec3 helper{1, 0, 0};
    if (std::abs(n.x) > 0.5f) helper = Vec3{0, 1, 0};
    const Vec3 x = normalize(cross(helper, n));
    const Vec3 y = cross(n, x);
    return n * cosine + x * (sine * std::cos(angle)) + y * (sine * std::sin(angle));
}

float mis_weight(float own, float other) {
    const float ratio = other / own;
    return 1 / (1 + ratio * ratio);
}

Rgb direct_light(const Light& light, const std::vector<Sphere>& spheres, Vec3 p, Vec3 n, Rgb albedo, Vec2 random) {
    const Vec3 q = sample_quad(light, random);
    const float density = light_density(light, p, q);
    if (density == 0) return Rgb(0);
    const Vec3 w = normalize(q - p);
    const float cosine = dot(n, w);
    if (cosine <= 0) return Rgb(0);
    const Ray shadow{p, w, 0.001f, length(q - p)};
    if (lesson::closest_hit(spheres, shadow)) return Rgb(0);
    return albedo / kPi * light.emission * cosine / density;
}

} // namespace duet::lab
