// Directions and points of lights drawn with known densities, and paths that look for the light.
#pragma once

#include "raytrace/lessons/07-camera/camera.h"
#include "raytrace/lessons/10-cornell-box/quads.h"

namespace duet::lesson {

/// A density of unit directions w, per steradian, in proportion to cosᵉ of the angle from `axis` (e = 1: Lambert).
inline float lobe_density(Vec3 axis, float e, Vec3 w) {
    return (e + 1) / (2 * kPi) * std::pow(max(dot(axis, w), 0.0f), e);
}

/// A random direction with that density.
inline Vec3 draw_lobe(Vec3 axis, float e, Random& random) {
    const float cosine = std::pow(1 - random.next(), 1 / (e + 1)), angle = 2 * kPi * random.next();
    const Vec3 beside = std::abs(axis.x) > 0.5f ? Vec3{0, 1, 0} : Vec3{1, 0, 0}; // any vector off the axis
    const Vec3 x = normalize(cross(beside, axis)), y = cross(axis, x);
    return axis * cosine + (x * std::cos(angle) + y * std::sin(angle)) * std::sqrt(1 - cosine * cosine);
}

/// The density, per steradian from p, of a point q of a quad whose points are all equally likely; 0 behind the quad.
inline float quad_density(const Quad& quad, Vec3 p, Vec3 q) {
    const float r2 = length_squared(q - p), cosine = dot(quad.n, p - q) / std::sqrt(r2);
    return cosine > 0 ? r2 / (length(cross(quad.u, quad.v)) * cosine) : 0;
}

/// What a sample counts for, by the density with which it was drawn and by that of the other way to draw it.
using MisWeight = float (*)(float own, float other);
inline float all(float, float) { return 1; }
inline float none(float, float) { return 0; }
inline float power_heuristic(float own, float other) { return 1 / (1 + sqr(other / own)); } // (Veach 1997, chapter 9)
struct Strategy {
    MisWeight chance, light; ///< of a light that the path meets by chance, and of one of which a point is drawn
};
struct Scene {
    std::vector<Quad> quads;
    float lights;  ///< how many of the quads, from the first on, shine
    Camera camera; ///< of a picture that is 1 wide and high
    int bounces;
    long rays = 0; ///< sent so far
};
inline auto closest_hit(Scene& scene, const Ray& ray) { return ++scene.rays, closest_hit(scene.quads, ray); }

/// The light of a random path from the point (x, y) of the picture.
inline Rgb path_color(Scene& scene, float x, float y, const Strategy& strategy, Random& random) {
    Ray ray = scene.camera.ray(x, y, random);
    Rgb color, weight(1);
    float own = 0; // the density with which the ray's direction was drawn
    for (int i = 0; i <= scene.bounces; ++i) {
        const std::optional<Hit> hit = closest_hit(scene, ray);
        if (!hit) break;
        const Quad& quad = scene.quads[hit->index];
        const float other = quad_density(quad, ray.origin, hit->p) / scene.lights; // were the quad a light
        if (hit->front) color += weight * quad.emission * (i == 0 ? 1 : strategy.chance(own, other));
        weight *= quad.material.albedo;
        if (is_black(weight) || i == scene.bounces) break;
        const float e = quad.material.kind == Material::Kind::kMetal ? 2 / sqr(quad.material.fuzz) : 1;
        const Vec3 axis = e > 1 ? mirror(normalize(ray.direction), hit->n) : hit->n;
        if (strategy.light != none) {
            const Quad& light = scene.quads[static_cast<std::size_t>(random.next() * scene.lights)];
            const float a = random.next(), b = random.next();
            const Vec3 q = light.corner + light.u * a + light.v * b, to_q = q - hit->p;
            const float p = quad_density(light, hit->p, q) / scene.lights, f = lobe_density(axis, e, normalize(to_q));
            if (p > 0 && dot(to_q, hit->n) > 0 && !closest_hit(scene, {hit->p, to_q, 1e-3f, 0.999f}))
                color += weight * light.emission * (f / p * strategy.light(p, f));
        }
        ray = {hit->p, draw_lobe(axis, e, random), 1e-3f};
        if (dot(ray.direction, hit->n) <= 0) break; // into the metal
        own = lobe_density(axis, e, ray.direction);
    }
    return color;
}

} // namespace duet::lesson
