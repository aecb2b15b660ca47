// The library's quads (common/geometry/quad.h), boxes (common/geometry/shape.h) and lights (common/light/light.h);
// paths as in the lesson.
#include "common/geometry/quad.h"
#include "common/light/light.h"
#include "raytrace/lessons/10-cornell-box/lab.h"
#include "raytrace/lessons/10-cornell-box/quads.h"

namespace duet::lab {

std::optional<float> hit_quad(const Quad& quad, const Ray& ray) {
    const auto hit = intersect_quad(ShearedRay(ray), duet::Quad{quad.corner, quad.u, quad.v});
    return hit ? std::optional(hit->t) : std::nullopt;
}

std::vector<Quad> box_of_quads(Vec3 low, Vec3 high, Rgb albedo) {
    std::vector<Quad> sides;
    for (const duet::Quad& quad : box_quads(low, high).quads) sides.push_back({quad.corner, quad.u, quad.v, albedo});
    return sides;
}

Rgb emitted(const Quad& quad, Vec3 ray_direction) {
    const SurfaceLight light{.shape = duet::Quad{quad.corner, quad.u, quad.v}, .radiance = quad.emission};
    return emits_towards(light, quad.corner - ray_direction) ? quad.emission : Rgb(0);
}

std::optional<lesson::Hit> closest_hit(const std::vector<Quad>& quads, const Ray& ray) {
    std::optional<lesson::Hit> closest;
    for (std::size_t i = 0; i < quads.size(); ++i) {
        const auto t = hit_quad(quads[i], ray);
        if (t && (!closest || *t < closest->t))
            closest = lesson::make_hit(ray, *t, normalize(cross(quads[i].u, quads[i].v)), i);
    }
    return closest;
}

Rgb path_color(const std::vector<Quad>& quads, const Ray& ray, int bounces, int seed) {
    std::vector<lesson::Quad> placed;
    for (const Quad& quad : quads)
        placed.push_back({quad.corner, quad.u, quad.v, lesson::matte(quad.albedo), quad.emission});
    lesson::Random random(static_cast<std::uint64_t>(seed));
    return lesson::path_color(placed, ray, bounces, random);
}

} // namespace duet::lab
