// Spheres on the ground: the scene of this lesson and the next.
#pragma once

#include "raytrace/lessons/02-sphere/eye.h"
#include "raytrace/lessons/02-sphere/sky.h"
#include "raytrace/lessons/03-surfaces/surfaces.h"

namespace duet::lesson {

/// Twelve spheres that stand on a large one, the ground. It is the first of the list. Its top is at (0, -1, -5); from
/// there the ground falls off by about x²/2R at a distance x, where R is its radius.
inline std::vector<Sphere> sphere_scene(float ground = 100) {
    std::vector<Sphere> spheres{{{0, -1 - ground, -5}, ground}};
    const auto stand = [&](float x, float z, float radius) {
        const float fall = (x * x + (z + 5) * (z + 5)) / (2 * ground);
        spheres.push_back({{x, radius - 1 - fall, z}, radius});
    };
    stand(0, -5, 1), stand(-2.1f, -5.8f, 0.8f), stand(2.05f, -5.3f, 0.7f), stand(3.9f, -8, 1.1f);
    stand(-4.4f, -8.5f, 1), stand(1.5f, -9, 1.3f), stand(-0.95f, -3.7f, 0.35f), stand(0.95f, -3.6f, 0.3f);
    stand(1.75f, -4, 0.25f), stand(-1.8f, -4, 0.3f), stand(0.12f, -3.2f, 0.2f), stand(-0.35f, -3, 0.12f);
    return spheres;
}

/// What a ray sees of that scene: a checkerboard on the ground, the normals of the other spheres, or the sky.
inline Rgb scene_color(const std::vector<Sphere>& spheres, const Ray& ray) {
    const std::optional<Hit> hit = closest_hit(spheres, ray);
    if (!hit) return sky_color(ray.direction);
    if (hit->index > 0) return normal_color(hit->n);
    const bool dark = (std::lround(std::floor(hit->p.x * 2)) + std::lround(std::floor(hit->p.z * 2))) % 2 != 0;
    return dark ? Rgb(0.12f, 0.3f, 0.1f) : Rgb(0.75f, 0.8f, 0.6f);
}

} // namespace duet::lesson
