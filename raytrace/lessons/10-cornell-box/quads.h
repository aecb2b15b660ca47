// Quads that may shine, the Cornell box, and the light that a path among them collects.
#pragma once

#include "raytrace/lessons/06-metal-and-glass/materials.h"

#include <array>

namespace duet::lesson {

/// A parallelogram: the points corner + a·u + b·v with a and b from 0 to 1. Give the first five members; the others
/// follow from them.
struct Quad {
    Vec3 corner, u, v;
    Material material;
    Rgb emission{};                                ///< the radiance that the front sends out: black but for lights
    Vec3 n = normalize(cross(u, v));               ///< the unit normal of the front
    Vec3 to_a = cross(v, n) / dot(u, cross(v, n)); ///< to_a·(a·u + b·v) = a
    Vec3 to_b = cross(n, u) / dot(v, cross(n, u)); ///< to_b·(a·u + b·v) = b
};

/// The distance t at which the ray meets the quad; nothing where it misses. (Ray Tracing: The Next Week, §6)
inline std::optional<float> hit_quad(const Quad& quad, const Ray& ray) {
    const float t = dot(quad.n, quad.corner - ray.origin) / dot(quad.n, ray.direction);
    if (!(t > ray.t_min && t < ray.t_max)) return std::nullopt; // also where the ray is parallel to the plane
    const Vec3 d = ray.at(t) - quad.corner;                     // = a·u + b·v
    const float a = dot(quad.to_a, d), b = dot(quad.to_b, d);
    return a >= 0 && a <= 1 && b >= 0 && b <= 1 ? std::optional(t) : std::nullopt;
}

/// The nearest hit of any quad, or nothing. The hit is at the front where the ray comes against the normal.
inline std::optional<Hit> closest_hit(const std::vector<Quad>& quads, Ray ray) {
    std::optional<Hit> closest;
    for (std::size_t i = 0; i < quads.size(); ++i)
        if (const auto t = hit_quad(quads[i], ray)) ray.t_max = *t, closest = make_hit(ray, *t, quads[i].n, i);
    return closest;
}

/// The six sides of the box with the edges a, b and c at its corner, where a × b points to the side of c. All normals
/// point outward.
inline void add_box(std::vector<Quad>& quads, Vec3 corner, Vec3 a, Vec3 b, Vec3 c, const Material& material) {
    for (const auto& [u, v, w] : {std::array{a, b, c}, {b, c, a}, {c, a, b}})
        quads.push_back({corner, v, u, material}), quads.push_back({corner + w, u, v, material});
}

/// The Cornell box, 2 m wide. Its first quad is the light. `side` scales the sides of the light and leaves the amount
/// of light that it sends out as it is; `power` scales that amount. (Geometry: Bitterli 2016, Rendering resources)
inline std::vector<Quad> cornell_box(float side = 1, float power = 1) {
    const Material white = matte({0.725f, 0.71f, 0.68f}), black = matte(Rgb(0));
    const Vec3 u{0.47f * side, 0, 0}, v{0, 0, 0.38f * side}, middle{-0.005f, 1.98f, -0.03f};
    std::vector<Quad> quads{
        {middle - (u + v) / 2.0f, u, v, black, Rgb(17, 12, 4) * (power / (side * side))}, // the light, front down
        {{-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, white},                                       // floor
        {{-1, 2, -1}, {2, 0, 0}, {0, 0, 2}, white},                                       // ceiling
        {{-1, 0, -1}, {2, 0, 0}, {0, 2, 0}, white},                                       // back wall
        {{-1, 0, 1}, {0, 0, -2}, {0, 2, 0}, matte({0.63f, 0.065f, 0.05f})},               // left wall, red
        {{1, 0, -1}, {0, 0, 2}, {0, 2, 0}, matte({0.14f, 0.45f, 0.091f})}};               // right wall, green
    add_box(quads, {-0.04608f, 0, 0.57301f}, {0.57908f, 0, 0.17307f}, {0.17033f, 0, -0.5699f}, {0, 0.6f, 0}, white);
    add_box(quads, {-0.72044f, 0, -0.47388f}, {0.19646f, 0, 0.56453f}, {0.57355f, 0, -0.1996f}, {0, 1.2f, 0}, white);
    return quads;
}

/// The light that a ray brings: at each quad what it sends out itself, times the albedos of the quads before it. A path
/// ends after `bounces` reflections, and where it leaves the quads: outside it is dark.
inline Rgb path_color(const std::vector<Quad>& quads, Ray ray, int bounces, Random& random) {
    Rgb light, weight(1);
    for (int i = 0; i <= bounces && !is_black(weight); ++i) {
        const std::optional<Hit> hit = closest_hit(quads, ray);
        if (!hit) break;
        const Quad& quad = quads[hit->index];
        if (hit->front) light += weight * quad.emission;
        const auto scattered = scatter(quad.material, ray, *hit, random);
        if (!scattered) break;
        weight *= scattered->weight, ray = scattered->ray;
    }
    return light;
}

} // namespace duet::lesson
