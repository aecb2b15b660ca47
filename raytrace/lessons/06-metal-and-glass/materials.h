// Matte, metal and glass surfaces, and the color of a path that bounces between them.
#pragma once

#include "common/image/rgb.h"
#include "raytrace/lessons/02-sphere/sky.h"
#include "raytrace/lessons/03-surfaces/surfaces.h"
#include "raytrace/lessons/05-diffuse/diffuse.h"

namespace duet::lesson {

struct Material {
    enum class Kind { kMatte, kMetal, kGlass };
    Kind kind = Kind::kMatte;
    Rgb albedo{1, 1, 1}; ///< the fraction of light that is reflected, 0 to 1 (matte and metal)
    float fuzz = 0;      ///< the radius of the blur around the mirror direction, 0 to 1 (metal)
    float ior = 1.5f;    ///< the index of refraction of the inside relative to the outside (glass)
};

/// The direction d mirrored at a surface of unit normal n. Unlike duet::reflect, d points toward the surface.
inline Vec3 mirror(Vec3 d, Vec3 n) { return d - n * (2 * dot(d, n)); }

/// Snell's law: the unit direction d, pointing toward the surface, bent where the index of refraction changes by
/// ratio = outside / inside as seen from d; nothing where all light is reflected. (Ray Tracing in One Weekend, §11.2)
inline std::optional<Vec3> refract(Vec3 d, Vec3 n, float ratio) {
    const float cosine = -dot(d, n);
    const float sine2 = ratio * ratio * (1 - cosine * cosine); // the squared sine of the refracted ray's angle
    if (sine2 > 1) return std::nullopt;
    return d * ratio + n * (ratio * cosine - std::sqrt(1 - sine2));
}

/// Schlick's approximation of the fraction of light that glass reflects; cosine is that of the angle in the thinner
/// medium. (Schlick 1994, "An Inexpensive BRDF Model for Physically-based Rendering", eq. 15)
inline float schlick(float cosine, float ior) {
    const float r0 = (1 - ior) / (1 + ior);
    return r0 * r0 + (1 - r0 * r0) * std::pow(1 - cosine, 5.0f);
}

/// A ray that goes on from a hit, and the fraction of its light that comes back along the ray that hit.
struct Scattered {
    Ray ray;
    Rgb weight;
};

/// Where light that leaves `hit` against the direction of `ray` may have come from; nothing where it is absorbed.
inline std::optional<Scattered> scatter(const Material& material, const Ray& ray, const Hit& hit, Random& random) {
    const Vec3 d = normalize(ray.direction);
    const auto leave = [&](Vec3 direction, Rgb weight) { return Scattered{{hit.p, direction, 1e-3f}, weight}; };
    if (material.kind == Material::Kind::kMatte)
        return leave(random_diffuse_direction(hit.n, random), material.albedo);
    if (material.kind == Material::Kind::kMetal) {
        const Vec3 direction = mirror(d, hit.n) + random_unit_vector(random) * material.fuzz;
        if (dot(direction, hit.n) <= 0) return std::nullopt; // the blur points into the metal
        return leave(direction, material.albedo);
    }
    const auto refracted = refract(d, hit.n, hit.front ? 1 / material.ior : material.ior);
    if (!refracted) return leave(mirror(d, hit.n), Rgb(1)); // total reflection
    const float cosine = hit.front ? -dot(d, hit.n) : -dot(*refracted, hit.n);
    return leave(random.next() < schlick(cosine, material.ior) ? mirror(d, hit.n) : *refracted, Rgb(1));
}

/// The light that comes along a ray under the sky, after at most `bounces` bounces. `closest(ray)` finds the nearest
/// hit, whose index also names its material.
template <typename Closest>
Rgb path_color(const Closest& closest, const std::vector<Material>& materials, Ray ray, int bounces, Random& random) {
    Rgb weight(1);
    for (int i = 0; i <= bounces; ++i) {
        const std::optional<Hit> hit = closest(ray);
        if (!hit) return weight * sky_color(ray.direction);
        const auto scattered = scatter(materials[hit->index], ray, *hit, random);
        if (!scattered) return Rgb(0);
        weight *= scattered->weight;
        ray = scattered->ray;
    }
    return Rgb(0); // light that bounced more often is left out
}

} // namespace duet::lesson
