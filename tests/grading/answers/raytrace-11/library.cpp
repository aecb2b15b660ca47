// The library's densities (common/light/area_sampling.h, common/sampling/warp.h), frame (common/vec/frame.h) and weight
// (raytrace/integrator/mis.h).
#include "common/light/area_sampling.h"
#include "common/sampling/warp.h"
#include "common/vec/frame.h"
#include "raytrace/integrator/mis.h"
#include "raytrace/lessons/11-monte-carlo/lab.h"

namespace duet::lab {

float draw_power(float k, float u) { return std::pow(u, 1 / (k + 1)); }

Vec3 sample_quad(const Light& light, Vec2 random) { return light.corner + light.u * random.x + light.v * random.y; }

float light_density(const Light& light, Vec3 p, Vec3 q) {
    const Vec3d w = Vec3d(q) - Vec3d(p);
    const AreaSampling<double> seen{cross(Vec3d(light.u), Vec3d(light.v)), w};
    return dot(seen.area_vector, w) < 0 ? static_cast<float>(seen.pdf(w)) : 0;
}

float cosine_density(Vec3 n, Vec3 w) { return cosine_hemisphere_pdf(dot(n, w)); }

Vec3 cosine_direction(Vec3 n, Vec2 random) { return frame_from_normal(n).to_world(cosine_hemisphere(random)); }

float mis_weight(float own, float other) { return raytrace::mis_weight(own, other); }

Rgb direct_light(const Light& light, const std::vector<Sphere>& spheres, Vec3 p, Vec3 n, Rgb albedo, Vec2 random) {
    const Vec3 q = sample_quad(light, random), w = normalize(q - p);
    const float density = light_density(light, p, q), cosine = dot(n, w);
    if (density == 0 || cosine <= 0 || lesson::closest_hit(spheres, {p, w, 0.001f, length(q - p)})) return Rgb(0);
    return albedo * light.emission * (cosine_density(n, w) / density);
}

} // namespace duet::lab
