// Matte, metal and glass surfaces, and the color of a path that bounces between them.
#pragma once

#include "raytrace/lessons/02-sphere/sky.h"
#include "raytrace/lessons/03-surfaces/surfaces.h"
#include "raytrace/lessons/05-diffuse/diffuse.h"

namespace duet::lesson {

struct Material {
    enum class Kind { kMatte, kMetal, kGlass } kind = Kind::kMatte;
    Rgb albedo{1, 1, 1}; ///< the fraction of light that goes on, 0 to 1; the rest is absorbed
    float fuzz = 0;      ///< the radius of the blur around the mirror direction, 0 to 1 (metal)
    float ior = 1.5f;    ///< the index of refraction of the inside relative to the outside (glass)
};
inline Material matte(Rgb albedo) { return {Material::Kind::kMatte, albedo}; }
inline Material metal(Rgb albedo, float fuzz = 0) { return {Material::Kind::kMetal, albedo, fuzz}; }
inline Material glass(float ior) { return {Material::Kind::kGlass, Rgb(1), 0, ior}; }

/// The direction d mirrored at a surface of unit normal n. Unlike duet::reflect, d points toward the surface.
inline Vec3 mirror(Vec3 d, Vec3 n) { return d - n * (2 * dot(d, n)); }

/// Snell's law: the unit vector d bends at a surface whose unit normal n is on the side that d comes from. ratio: the
/// index there over the index beyond. Nothing where all light is reflected. (Ray Tracing in One Weekend, §11.2)
inline std::optional<Vec3> refract(Vec3 d, Vec3 n, float ratio) {
    const float cosine = -dot(d, n);
    const float sine2 = ratio * ratio * (1 - cosine * cosine); // the squared sine of the refracted ray's angle
    if (sine2 > 1) return std::nullopt;
    return d * ratio + n * (ratio * cosine - std::sqrt(1 - sine2));
}

/// The fraction of light that glass reflects; cosine: of the ray in the medium of the smaller index. (Schlick 1994)
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
    Vec3 direction = mirror(d, hit.n);
    if (material.kind == Material::Kind::kMatte) direction = random_diffuse_direction(hit.n, random);
    if (material.kind == Material::Kind::kMetal) {
        direction += random_unit_vector(random) * material.fuzz;
        if (dot(direction, hit.n) <= 0) return std::nullopt; // the blur points into the metal
    }
    if (material.kind == Material::Kind::kGlass)
        if (const auto refracted = refract(d, hit.n, hit.front ? 1 / material.ior : material.ior)) {
            const float cosine = -dot(hit.front == (material.ior > 1) ? d : *refracted, hit.n); // at the smaller index
            if (random.next() >= schlick(cosine, material.ior)) direction = *refracted;
        }
    return Scattered{{hit.p, normalize(direction), 1e-3f}, material.albedo}; // t_min = 1 mm
}

/// The light that a ray under the sky brings. closest(ray) finds the nearest hit, whose index names its material.
template <typename Closest>
Rgb path_color(const Closest& closest, const std::vector<Material>& materials, Ray ray, int bounces, Random& random) {
    Rgb weight(1);
    for (int i = 0; i <= bounces; ++i) {
        const std::optional<Hit> hit = closest(ray);
        if (!hit) return weight * sky_color(ray.direction);
        const auto scattered = scatter(materials[hit->index], ray, *hit, random);
        if (!scattered) return Rgb(0);
        weight *= scattered->weight, ray = scattered->ray;
    }
    return Rgb(0); // light that bounced more often is left out
}

} // namespace duet::lesson
