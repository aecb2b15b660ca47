// Assignment 4: a path tracer with multiple importance sampling.
#pragma once

#include "common/image/image.h"
#include "common/vec/ray.h"
#include "tests/grading/lab.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace duet::lab {

/// A parallelogram: the points corner + a·u + b·v with a and b in [0, 1]. It is matte on both sides, and shines on the
/// side of the normal u × v alone.
struct Quad {
    Vec3 corner, u, v;
    Rgb albedo;   ///< the fraction of light that it reflects, 0 to 1
    Rgb emission; ///< radiance
};

/// A scene. The light that leaves it (rays that hit nothing) is black.
struct Scene {
    std::vector<Quad> quads;
    std::vector<int> lights; ///< the indices of the quads that shine
};

/// Where a ray meets a scene.
struct Hit {
    int quad = -1;
    float t = 0;
    Vec3 p, n;         ///< the point; the unit normal on the side from which the ray came
    bool front = true; ///< whether the ray came from the side of u × v
};

/// Given: the nearest quad on a ray, t > t_min; nothing where there is none.
inline std::optional<Hit> closest_hit(const Scene& scene, const Ray& ray) {
    std::optional<Hit> closest;
    float nearest = ray.t_max;
    for (std::size_t i = 0; i < scene.quads.size(); ++i) {
        const Quad& quad = scene.quads[i];
        const Vec3 n = cross(quad.u, quad.v);
        const float along = dot(n, ray.direction), t = dot(n, quad.corner - ray.origin) / along;
        if (along == 0 || !(t > ray.t_min && t < nearest)) continue;
        const Vec3 d = ray.at(t) - quad.corner, w = n / dot(n, n);
        const float a = dot(w, cross(d, quad.v)), b = dot(w, cross(quad.u, d));
        if (a < 0 || a > 1 || b < 0 || b > 1) continue;
        nearest = t;
        const Vec3 unit = normalize(n);
        closest = Hit{static_cast<int>(i), t, ray.at(t), along < 0 ? unit : -unit, along < 0};
    }
    return closest;
}

/// A direction toward a light.
struct LightSample {
    Vec3 wi;            ///< unit, from the point to the light
    float distance = 0; ///< to the point of the light
    float pdf = 0;      ///< of wi, per steradian; 0 where the light turns its dark side to the point
};

/// The direction from p to the point of the light at a = random.x, b = random.y, with its density when random is
/// uniform in [0, 1)².
LightSample sample_light(const Quad& light, Vec3 p, Vec2 random);

/// The density with which sample_light draws the unit direction wi from p, per steradian; 0 where a ray from p along wi
/// misses the light or meets its dark side. Nothing stands between: the scene isn't asked.
float light_pdf(const Quad& light, Vec3 p, Vec3 wi);

/// The power heuristic with exponent 2: the weight of a sample drawn with density pdf, where another way would have
/// drawn it with density other. In [0, 1]; it is 0 where pdf is 0. Densities may be as large as 1e30.
float power_heuristic(float pdf, float other);

/// How light is found. All three give the same picture, with different noise.
enum class Strategy {
    kBsdf,  ///< paths run into lights by chance
    kLight, ///< at each vertex one light, chosen evenly, is sampled; running into one counts only for the camera's ray
    kMis    ///< both, weighed by the power heuristic
};

/// The radiance along each ray: the mean of `samples` paths. A path has at most `bounces` reflections: with 0 only what
/// shines is seen, with 1 there is direct light too. No Russian roulette. The same seed gives the same numbers.
std::vector<Rgb> radiance(const Scene& scene, const std::vector<Ray>& rays, int samples, int bounces, Strategy strategy,
                          std::uint32_t seed);

} // namespace duet::lab

DUET_LAB(sample_light, light_pdf, power_heuristic, radiance)
