#include "common/light/light.h"

#include <cmath>

namespace duet {

namespace {

using Triangle = SurfaceLight::Triangle;

/// Returns the sample of a light at a single position: intensity over squared distance. The computation is in double,
/// so that no intermediate value overflows.
std::optional<LightSample> sample_position(Vec3 position, Rgb intensity, Vec3 p) {
    const Vec3d to_light = Vec3d(position) - Vec3d(p);
    const double d2 = length_squared(to_light);
    if (!(d2 > 0)) return std::nullopt;
    const double d = std::sqrt(d2);
    const Rgb incident(Rgbd(intensity) / d2);
    if (!is_finite(incident)) return std::nullopt;
    return LightSample{Vec3(to_light / d), static_cast<float>(d), incident, 1, true};
}

std::optional<LightSample> draw(const PointLight& light, Vec3 p, Vec2) {
    return sample_position(light.position, light.intensity, p);
}

std::optional<LightSample> draw(const SpotLight& light, Vec3 p, Vec2) {
    std::optional<LightSample> s = sample_position(light.position, light.intensity, p);
    if (!s) return std::nullopt;
    const float falloff = spot_falloff(light, -dot(s->wi, light.direction));
    if (!(falloff > 0)) return std::nullopt;
    s->radiance *= falloff;
    return s;
}

std::optional<LightSample> draw(const SunLight& light, Vec3, Vec2) {
    return LightSample{-light.direction, kInfinity, light.irradiance, 1, true};
}

std::optional<LightSample> draw(const SurfaceLight& light, Vec3 p, Vec2 u) {
    if (!emits_towards(light, p)) return std::nullopt;
    const auto s =
        std::visit([&](const auto& shape) { return sample_solid_angle(shape, Vec3d(p), Vec2d(u)); }, light.shape);
    if (!s || !is_usable_pdf(s->pdf)) return std::nullopt;
    return LightSample{Vec3(s->wi), static_cast<float>(s->distance), light.radiance, static_cast<float>(s->pdf), false};
}

template <typename Flat> double area_of(const Flat& flat) { return length(area_seen(flat, Vec3d()).area_vector); }
double area_of(const Sphere& s) { return 4 * kPiDouble * sqr(static_cast<double>(s.radius)); }

/// A light's flux is factor·quantity. The quantity is its radiance, intensity or irradiance.
struct Flux {
    double factor;
    Rgb quantity;
};
Flux flux(const PointLight& light, double) { return {4 * kPiDouble, light.intensity}; }
Flux flux(const SpotLight& light, double) {
    // The falloff is antisymmetric about the middle of its range of cosines, so its mean there is ½.
    const double inner = static_cast<double>(light.cos_inner), outer = static_cast<double>(light.cos_outer);
    return {2 * kPiDouble * ((1 - inner) + (inner - outer) / 2), light.intensity};
}
Flux flux(const SunLight& light, double scene_radius) { return {kPiDouble * sqr(scene_radius), light.irradiance}; }
Flux flux(const SurfaceLight& light, double) {
    return {kPiDouble * area(light) * (light.two_sided ? 2 : 1), light.radiance};
}

} // namespace

bool emits_towards(const SurfaceLight& light, Vec3 p) {
    if (const auto* sphere = std::get_if<Sphere>(&light.shape)) {
        const double front =
            length_squared(Vec3d(p) - Vec3d(sphere->center)) - sqr(static_cast<double>(sphere->radius));
        return front != 0 && (light.two_sided || front > 0);
    }
    const auto* quad = std::get_if<Quad>(&light.shape);
    return quad != nullptr ? area_seen(*quad, Vec3d(p)).emits(light.two_sided)
                           : area_seen(std::get<Triangle>(light.shape), Vec3d(p)).emits(light.two_sided);
}

std::optional<LightSample> sample_light(const Light& light, Vec3 p, Vec2 u) {
    return std::visit([&](const auto& l) { return draw(l, p, u); }, light);
}

float light_pdf(const SurfaceLight& light, Vec3 p, Vec3 q) {
    if (!emits_towards(light, p)) return 0;
    const double pdf =
        std::visit([&](const auto& shape) { return solid_angle_pdf(shape, Vec3d(p), Vec3d(q)); }, light.shape);
    return is_usable_pdf(pdf) ? static_cast<float>(pdf) : 0.0f;
}

Rgb intensity(const SpotLight& light, Vec3 w) { return light.intensity * spot_falloff(light, dot(w, light.direction)); }

double area(const SurfaceLight& light) {
    return std::visit([](const auto& shape) { return area_of(shape); }, light.shape);
}

float light_power(const Light& light, float scene_radius) {
    const Flux f = std::visit([&](const auto& l) { return flux(l, static_cast<double>(scene_radius)); }, light);
    return static_cast<float>(f.factor * static_cast<double>(average(f.quantity)));
}

bool is_black(const Light& light) {
    return std::visit([](const auto& l) { return is_black(flux(l, 1.0).quantity); }, light);
}

} // namespace duet
