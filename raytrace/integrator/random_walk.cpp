#include "raytrace/integrator/random_walk.h"

#include "common/medium/medium.h"
#include "common/sampling/warp.h"
#include "raytrace/sampling/random_sequence.h"
#include "raytrace/integrator/russian_roulette.h"
#include "raytrace/integrator/vertex.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace duet::raytrace {

namespace {

constexpr int kMaxRays = 30000;

// Carries the path along the ray to the next collision or, if that comes first, to the hit. `hit_known` says whether
// `hit` is the ray's hit; if not, it is computed. Returns the distance of the collision, if there is one.
std::optional<float> next_collision(const RenderPlan& plan, const SolidInterior& interior, Ray& ray, Hit& hit,
                                    bool hit_known, RandomSequence& random, PathThroughputT<float>& path) {
    const Rgb extinction = interior.scattering + interior.absorption;
    const ChosenChannel channel(path.throughput, random());
    const float drawn = -std::log1p(-random()) / extinction[channel.index];
    if (!hit_known) {
        ray.t_max = drawn; // hits behind the collision do not matter
        hit = plan.prepared.accelerator.closest(ray);
    }
    // Rounding may move a collision close to the surface to its other side. The walk then continues as if it were still
    // inside the solid, and soon hits the surface from outside, which it passes.
    const bool collides = hit.t > drawn;
    const float t = collides ? drawn : hit.t;
    const Rgb passed = transmittance(extinction * t);
    const float density = channel.mean(collides ? extinction * passed : passed);
    path.throughput *= (collides ? interior.scattering * passed : passed) / density;
    return collides ? std::optional(t) : std::nullopt;
}

// Stores the solids that a path is inside of. At an edge that a ray just touches, it may hit a surface from the wrong
// side. Entering or leaving a solid twice therefore counts once.
class EnteredSolids {
public:
    explicit EnteredSolids(std::uint32_t object) { enter(object); }
    void enter(std::uint32_t object) {
        if (std::ranges::find(objects_, object) == objects_.end()) objects_.push_back(object);
    }
    // Returns whether the path is now outside of all solids.
    bool leave(std::uint32_t object) {
        std::erase(objects_, object);
        return objects_.empty();
    }

private:
    std::vector<std::uint32_t> objects_;
};

// Returns whether a walk is farther from the scene's objects than they are large. It has left an open mesh through its
// hole, and rarely comes back.
bool is_lost(Vec3 p, const Box3& bounds) {
    const Vec3 outside = max(bounds.low - p, p - bounds.high);
    return max_component(outside) > max_component(bounds.diagonal());
}

// Reflects the path diffusely.
void reflect(const SurfacePoint& point, Ray& ray, RandomSequence& random) {
    const Vec3 n = dot(point.ng, ray.direction) > 0 ? -point.ng : point.ng;
    const Vec2 u{random(), random()};
    ray.direction = normalize(frame_from_normal(n).to_world(cosine_hemisphere(u)));
    ray.origin = offset_origin(point.p, point.p_error, n);
}

// Returns a viewer's ray from in front of the surface, whose distance to the hit equals that of `ray`.
Ray seen_from_outside(const SurfacePoint& point, const Ray& ray, const Hit& hit) {
    Ray outside{point.p + point.ng * hit.t, -point.ng};
    outside.time = ray.time;
    return outside;
}

} // namespace

std::optional<SolidExit> random_walk(const RenderPlan& plan, const EnteredSolid& solid, Ray ray, Hit hit, float u,
                                     PathThroughputT<float>& path, Rgb& emitted_light, RayCounts& counts) {
    RandomSequence random(u);
    EnteredSolids entered(solid.object);
    int collisions = 0;
    for (int rays = 0; rays < kMaxRays; ++rays, ++counts.indirect) {
        if (is_black(path.throughput)) return std::nullopt;
        if (const auto t = next_collision(plan, solid.interior, ray, hit, rays == 0, random, path)) {
            ++collisions;
            ray.origin = ray.at(*t);
            if (is_lost(ray.origin, plan.scene.bounds)) return std::nullopt;
            const Vec2 direction{random(), random()};
            ray.direction = uniform_sphere(direction);
        } else {
            const std::uint32_t index = material_index(plan.scene, hit.object, hit.primitive);
            const SurfacePoint point = surface_point(plan.scene, ray, hit, nullptr, plan.details[index]);
            const Material& material = plan.scene.materials[index];
            if (has_subsurface(material)) {
                const bool leaves = dot(point.ng, ray.direction) > 0;
                if (!leaves) entered.enter(hit.object);
                if (leaves && entered.leave(hit.object))
                    return SolidExit{ray, seen_from_outside(point, ray, hit), hit, collisions};
                ray.origin = offset_origin(point.p, point.p_error, leaves ? point.ng : -point.ng);
            } else {
                emitted_light += path.throughput * emitted(material, plan.scene.textures, point, -ray.direction);
                path.throughput *= base_color(material, plan.scene.textures, point);
                reflect(point, ray, random);
            }
        }
        if (plan.russian_roulette && !russian_roulette(random(), path).survives) {
            ++counts.ended;
            return std::nullopt;
        }
    }
    return std::nullopt;
}

} // namespace duet::raytrace
