#include "common/light/light_bounds.h"

#include "common/system/error.h"

#include <array>
#include <cmath>
#include <span>

namespace duet {

namespace {

/// Returns the angle between two unit vectors. Unlike the arc cosine, it is accurate for nearly parallel vectors.
float angle_between(Vec3 a, Vec3 b) { return 2 * std::atan2(length(a - b), length(a + b)); }

/// Returns v rotated by an angle toward the unit vector `to`, which must not be parallel to v.
Vec3 rotated_towards(Vec3 v, Vec3 to, float angle) {
    return normalize(v * std::cos(angle) + normalize(to - v * dot(v, to)) * std::sin(angle));
}

LightBounds omnidirectional_bounds(Vec3 position, float intensity) {
    LightBounds bounds;
    if (!(intensity > 0)) return bounds;
    bounds.box.extend(position);
    bounds.cos_normals = -1;
    bounds.intensity = intensity;
    return bounds;
}

LightBounds flat_light_bounds(std::span<const Vec3> corners, Vec3 area, const SurfaceLight& light) {
    LightBounds bounds;
    const float size = length(area);
    const float intensity = size * average(light.radiance);
    if (!(intensity > 0)) return bounds;
    for (const Vec3 p : corners) bounds.box.extend(p);
    bounds.axis = area / size;
    bounds.cos_normals = light.two_sided ? -1.0f : 1.0f;
    bounds.intensity = intensity;
    return bounds;
}

struct {
    LightBounds operator()(const PointLight& light) const {
        return omnidirectional_bounds(light.position, average(light.intensity));
    }
    LightBounds operator()(const SpotLight& light) const { // the cone is not bounded: spot lights are few
        return omnidirectional_bounds(light.position, average(light.intensity));
    }
    LightBounds operator()(const SunLight&) const {
        DUET_CHECK(false);
        return {};
    }
    LightBounds operator()(const SurfaceLight& light) const {
        if (const auto* quad = std::get_if<Quad>(&light.shape))
            return flat_light_bounds(corners(*quad), cross(quad->u, quad->v), light);
        if (const auto* t = std::get_if<SurfaceLight::Triangle>(&light.shape))
            return flat_light_bounds(std::array{t->a, t->b, t->c}, cross(t->b - t->a, t->c - t->a) * 0.5f, light);
        const auto& sphere = std::get<Sphere>(light.shape);
        LightBounds bounds = omnidirectional_bounds(sphere.center, kPi * sqr(sphere.radius) * average(light.radiance));
        const Vec3 extent(sphere.radius, sphere.radius, sphere.radius);
        if (!bounds.empty()) bounds.box = {sphere.center - extent, sphere.center + extent};
        return bounds;
    }
} const kBoundsVisitor;

/// Returns cos max(0, a − b) for angles a and b in [0, π], given by their cosines and sines.
float cos_of_difference(float cos_a, float sin_a, float cos_b, float sin_b) {
    return cos_a > cos_b ? 1.0f : cos_a * cos_b + sin_a * sin_b;
}
/// Returns sin max(0, a − b) for angles a and b in [0, π], given by their cosines and sines.
float sin_of_difference(float cos_a, float sin_a, float cos_b, float sin_b) {
    return cos_a > cos_b ? 0.0f : sin_a * cos_b - cos_a * sin_b;
}

/// All estimates are clamped to this value, so that sums of them do not overflow.
constexpr float kMaxEstimate = 1e30f;

} // namespace

void LightBounds::extend(const LightBounds& other) {
    if (other.empty()) return;
    if (empty()) {
        *this = other;
        return;
    }
    box.extend(other.box);
    intensity += other.intensity;
    // Find the smallest cone that contains both cones (Conty Estevez and Kulla 2018, algorithm 1).
    const float a = std::acos(clamp(cos_normals, -1.0f, 1.0f)), b = std::acos(clamp(other.cos_normals, -1.0f, 1.0f));
    const float between = angle_between(axis, other.axis);
    // kMargin is a margin for rounding: near 0° and 180° a cosine has only half of an angle's digits.
    constexpr float kMargin = 1e-3f;
    if (a >= between + b) return;
    if (b >= between + a) {
        axis = other.axis;
        cos_normals = other.cos_normals;
        return;
    }
    const float half = (a + between + b) / 2 + kMargin;
    if (half >= kPi || between > kPi - 1e-3f) {
        cos_normals = -1;
        return;
    }
    axis = rotated_towards(axis, other.axis, half - a);
    cos_normals = std::cos(half);
}

LightBounds light_bounds(const Light& light) { return std::visit(kBoundsVisitor, light); }

float irradiance_estimate(const LightBounds& bounds, const LightReceiver& receiver) {
    const Vec3 to_center = bounds.box.center() - receiver.p;
    const float d2 = length_squared(to_center), r2 = length_squared(bounds.box.diagonal()) / 4;
    // Inside the bounding sphere any angle is possible.
    if (!(d2 > r2)) return r2 > 0 ? min(bounds.intensity / r2, kMaxEstimate) : 0;
    const float inverse_d = 1 / std::sqrt(d2);
    const Vec3 w = to_center * inverse_d;
    const float sin2_sphere = r2 / d2, cos_sphere = std::sqrt(1 - sin2_sphere), sin_sphere = std::sqrt(sin2_sphere);

    const auto sine = [](float cosine) { return safe_sqrt(1 - cosine * cosine); };
    float cos_receiver = 1;
    if (receiver.n != Vec3()) {
        const float c = clamp(dot(w, receiver.n), -1.0f, 1.0f);
        cos_receiver = cos_of_difference(c, sine(c), cos_sphere, sin_sphere);
        if (!(cos_receiver > 0)) return 0;
    }
    float cos_light = 1;
    if (bounds.cos_normals > -1) {
        const float c = clamp(-dot(w, bounds.axis), -1.0f, 1.0f), s = sine(c), cn = min(bounds.cos_normals, 1.0f);
        const float cos_rest = cos_of_difference(c, s, cn, sine(cn)), sin_rest = sin_of_difference(c, s, cn, sine(cn));
        cos_light = cos_of_difference(cos_rest, sin_rest, cos_sphere, sin_sphere);
        if (!(cos_light > 0)) return 0;
    }
    return min(bounds.intensity * cos_light * cos_receiver * sqr(inverse_d), kMaxEstimate);
}

} // namespace duet
