#include "raytrace/bidirectional/light_emission.h"

#include "common/sampling/warp.h"
#include "common/scene/emitter_texture.h"
#include "common/vec/frame.h"

#include <cmath>

namespace duet::raytrace {

namespace {

// Ray origins are offset by this fraction of the coordinates' magnitudes, which exceeds the rounding errors of both the
// light's point and the object's transform.
constexpr float kPositionError = gamma_bound(16);

// Holds a point of a surface light with its unit normal on the front side.
struct LightPoint {
    Vec3 p, p_error, n;
};

LightPoint point_of(const SurfaceLight::Triangle& t, Vec2 u) {
    const Vec2 b = uniform_triangle(u);
    return {t.a + (t.b - t.a) * b.x + (t.c - t.a) * b.y, (abs(t.a) + abs(t.b) + abs(t.c)) * kPositionError,
            normalize(cross(t.b - t.a, t.c - t.a))};
}
LightPoint point_of(const Quad& q, Vec2 u) {
    return {q.corner + q.u * u.x + q.v * u.y, (abs(q.corner) + abs(q.u) + abs(q.v)) * kPositionError,
            normalize(cross(q.u, q.v))};
}
LightPoint point_of(const Sphere& s, Vec2 u) {
    const Vec3 n = uniform_sphere(u);
    return {s.center + n * s.radius, (abs(s.center) + Vec3(s.radius, s.radius, s.radius)) * kPositionError, n};
}

Vec3 normal_at(const SurfaceLight& light, Vec3 q) {
    if (const auto* sphere = std::get_if<Sphere>(&light.shape)) return normalize(q - sphere->center);
    return std::visit([](const auto& shape) { return point_of(shape, Vec2(0, 0)).n; }, light.shape);
}

bool all_emitters_are_lights(const Scene& scene) {
    for (std::uint32_t o = 0; o < scene.objects.size(); ++o) {
        const std::size_t count = primitive_count(scene.shapes[scene.objects[o].shape]);
        for (std::uint32_t p = 0; p < count; ++p)
            if (emitter(scene.materials[material_index(scene, o, p)]) != nullptr &&
                surface_light_index(scene, o, p) < 0)
                return false;
    }
    return true;
}

double sphere_projection(double radius) { return kPiDouble * sqr(radius); }

} // namespace

LightEmission::LightEmission(const RenderPlan& plan)
    : plan_(plan), center_(plan.scene.bounds.center()),
      radius_(static_cast<double>(length(plan.scene.bounds.diagonal())) / 2),
      complete_(plan.environment == nullptr && all_emitters_are_lights(plan.scene)) {
    if (plan.lights == nullptr || plan.scene.bounds.empty()) return;
    std::vector<double> powers;
    for (const Light& light : plan.scene.lights)
        powers.push_back(static_cast<double>(light_power(light, static_cast<float>(radius_))));
    powers.push_back(plan.environment != nullptr
                         ? static_cast<double>(sampled_irradiance(*plan.environment)) * sphere_projection(radius_)
                         : 0);
    choice_ = Distribution1D(powers);
}

bool LightEmission::is_delta(std::size_t light) const {
    return light < plan_.scene.lights.size() && !std::holds_alternative<SurfaceLight>(plan_.scene.lights[light]);
}

double LightEmission::photon_fraction(Vec3 w) const {
    const double sampled = empty() ? 0 : static_cast<double>(pdf(*plan_.environment, w));
    return sampled / (sampled + static_cast<double>(kUniformSpherePdf));
}

EmissionDensity LightEmission::density(std::size_t index, Vec3 q, Vec3 w, Vec3 p) const {
    if (empty()) return {};
    const double chosen = static_cast<double>(choice_.probability(index));
    if (index == plan_.scene.lights.size())
        return {chosen * static_cast<double>(pdf(*plan_.environment, -w)) / sphere_projection(radius_), 1};
    const Light& light = plan_.scene.lights[index];
    if (std::holds_alternative<SunLight>(light)) return {chosen / sphere_projection(radius_), 1};
    if (const auto* surface = std::get_if<SurfaceLight>(&light)) {
        const double cosine = static_cast<double>(dot(normal_at(*surface, q), w));
        if (cosine <= 0 && !surface->two_sided) return {0, 1};
        const double sides = surface->two_sided ? 2 : 1;
        return {chosen * std::abs(cosine) / (kPiDouble * area(*surface) * sides), std::abs(cosine)};
    }
    const double squared_distance = length_squared(Vec3d(p) - Vec3d(q));
    if (const auto* spot = std::get_if<SpotLight>(&light)) {
        const bool inside = dot(w, spot->direction) > spot->cos_outer;
        return {inside ? chosen * uniform_cone_pdf(1 - static_cast<double>(spot->cos_outer)) : 0, squared_distance};
    }
    return {chosen * static_cast<double>(kUniformSpherePdf), squared_distance};
}

namespace {

// Draws a point on a surface light, and a cosine-distributed direction.
EmittedRay emit(const Scene& scene, const SurfaceLight& light, const EmissionRandomSamples& u) {
    const LightPoint point = std::visit([&](const auto& shape) { return point_of(shape, u.position); }, light.shape);
    const bool back = light.two_sided && u.direction.x >= 0.5f;
    Vec2 direction = u.direction;
    if (light.two_sided) direction.x = back ? 2 * direction.x - 1 : 2 * direction.x;
    const Vec3 n = back ? -point.n : point.n;
    const Vec3 local = cosine_hemisphere(direction);
    const Vec3 w = normalize(frame_from_normal(n).to_world(local));
    EmittedRay emitted{{offset_origin(point.p, point.p_error, n), w}, 0, point.p, light.radiance};
    if (scene.needs.emitter_textures) {
        const float distance = std::sqrt(static_cast<float>(area(light)));
        emitted.weight = radiance_toward(scene, light, point.p + w * distance, -w, distance);
    }
    emitted.weight *= abs(dot(n, w));
    return emitted;
}
EmittedRay emit(const Scene&, const PointLight& light, const EmissionRandomSamples& u) {
    return {{light.position, uniform_sphere(u.direction)}, 0, light.position, light.intensity};
}
EmittedRay emit(const Scene&, const SpotLight& light, const EmissionRandomSamples& u) {
    const Vec3 local(uniform_cone(Vec2d(u.direction), 1 - static_cast<double>(light.cos_outer)));
    const Vec3 w = normalize(frame_from_normal(light.direction).to_world(local));
    return {{light.position, w}, 0, light.position, intensity(light, w)};
}
// Leaves the origin of the ray from infinity to the caller.
EmittedRay emit(const Scene&, const SunLight& light, const EmissionRandomSamples&) {
    return {{{}, light.direction}, 0, {}, light.irradiance};
}
std::optional<EmittedRay> emit(const Environment& environment, const EmissionRandomSamples& u) {
    const std::optional<EnvironmentSample> s = duet::sample(environment, u.direction);
    return s ? std::optional(EmittedRay{{{}, -s->wi}, 0, {}, s->radiance}) : std::nullopt;
}

} // namespace

std::optional<EmittedRay> LightEmission::sample(const EmissionRandomSamples& u, float time) const {
    const std::size_t index = choice_.sample(u.choice).index;
    const bool environment = index == plan_.scene.lights.size();
    std::optional<EmittedRay> emitted =
        environment
            ? emit(*plan_.environment, u)
            : std::visit([&](const auto& light) { return emit(plan_.scene, light, u); }, plan_.scene.lights[index]);
    if (!emitted) return std::nullopt;
    Ray& ray = emitted->ray;
    if (environment || std::holds_alternative<SunLight>(plan_.scene.lights[index])) {
        const Frame frame = frame_from_normal(ray.direction);
        const Vec2 disk = concentric_disk(u.position) * static_cast<float>(radius_);
        ray.origin = center_ + frame.s * disk.x + frame.t * disk.y - ray.direction * static_cast<float>(radius_);
        emitted->position = ray.origin;
    }
    // A point or spot light may lie in a surface, which must not block its rays: see ShadowRayEnd.
    if (!environment && is_delta(index)) ray.t_min = max_component(abs(ray.origin)) * kPositionError;
    ray.time = time;
    emitted->light = index;
    const double density = this->density(index, emitted->position, ray.direction, ray.origin).density;
    if (!(density > 0)) return std::nullopt;
    emitted->weight = Rgb(Rgbd(emitted->weight) / density);
    return is_finite(emitted->weight) && !is_black(emitted->weight) ? emitted : std::nullopt;
}

} // namespace duet::raytrace
