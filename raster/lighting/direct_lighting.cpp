#include "raster/lighting/direct_lighting.h"

#include "common/light/form_factor.h"
#include "raster/lighting/area_specular.h"
#include "raster/lighting/incident_light.h"
#include "raster/shadows/shadows.h"

#include <array>
#include <cmath>

namespace duet::raster {
namespace {

constexpr Vec2 kCenter{0.5f, 0.5f};

struct Polygon {
    std::array<Vec3, 5> v;
    std::size_t count = 0;
};
Polygon polygon_of(const SurfaceLight::Triangle& t) { return {{t.a, t.b, t.c}, 3}; }
Polygon polygon_of(const Quad& q) { return {{q.corner, q.corner + q.u, q.corner + q.u + q.v, q.corner + q.v}, 4}; }

/// Clips a polygon to the half-space above the plane through p with normal n.
Polygon above(const Polygon& polygon, Vec3 p, Vec3 n) {
    Polygon result;
    const auto emit = [&](Vec3 v) {
        if (result.count < result.v.size()) result.v[result.count++] = v;
    };
    for (std::size_t i = 0; i < polygon.count; ++i) {
        const Vec3 a = polygon.v[i], b = polygon.v[(i + 1) % polygon.count];
        const float da = dot(n, a - p), db = dot(n, b - p);
        if (da >= 0) emit(a);
        if ((da > 0 && db < 0) || (da < 0 && db > 0)) emit(a + (b - a) * (da / (da - db)));
    }
    return result;
}

/// Returns the irradiance where the shading normal differs from `ShadingPoint::terminator_normal`. The light is clipped
/// at the plane of `terminator_normal` first; the closed form then clips it at the plane of the shading normal.
template <typename Shape>
Rgb irradiance_above(const SurfaceLight& light, const Shape& shape, const ShadingPoint& point) {
    const Vec3 p = point.surface.p;
    if (!emits_towards(light, p)) return {};
    const Polygon visible = above(polygon_of(shape), p, point.terminator_normal);
    if (visible.count < 3) return {};
    const std::span<const Vec3> vertices(visible.v.data(), visible.count);
    return light.radiance * static_cast<float>(polygon_form_factor_times_pi(p, point.ns, vertices));
}
/// A sphere counts in full unless all of it is below the horizon.
Rgb irradiance_above(const SurfaceLight& light, const Sphere& sphere, const ShadingPoint& point) {
    const float height = dot(point.terminator_normal, sphere.center - point.surface.p);
    return height > -sphere.radius ? surface_light_irradiance(light, point.surface.p, point.ns) : Rgb();
}

bool is_own(const SurfaceLight& light, const SurfacePoint& point) {
    return light.object == point.object && light.primitive == point.primitive;
}

Vec3 center(const SurfaceLight::Triangle& t) { return (t.a + t.b + t.c) * (1.0f / 3); }
Vec3 center(const Quad& q) { return q.corner + (q.u + q.v) * 0.5f; }
Vec3 center(const Sphere& s) { return s.center; }

/// This is a light treated as arriving from one direction, as a delta light does.
using Incident = IncidentT<float>;
std::optional<Incident> delta_light(const Light& light, Vec3 p) {
    const std::optional<LightSample> sample = sample_light(light, p, kCenter);
    if (!sample) return std::nullopt;
    return Incident{sample->wi, sample->radiance};
}

std::optional<Incident> from_center(const SurfaceLight& light, Vec3 p) {
    const Vec3 direction = std::visit([](const auto& shape) { return center(shape); }, light.shape) - p;
    if (!(length_squared(direction) > 0)) return std::nullopt;
    const Vec3 wi = normalize(direction);
    return Incident{wi, surface_light_irradiance(light, p, wi)};
}

template <typename BsdfType> Rgb reflected(const BsdfType& bsdf, const ShadingPoint& point, const Incident& light) {
    if (!point.receives(light.wi)) return {};
    const Vec3 wi = point.frame.to_local(light.wi);
    return bsdf.eval(point.wo, wi, TransportMode::kRadiance) * abs_cos_theta(wi) * light.irradiance;
}

} // namespace

ShadingPoint::ShadingPoint(const SurfacePoint& point, Vec3 to_viewer)
    : surface(point), frame(frame_from_normal(point.ns)) {
    const float side = dot(point.ng, to_viewer) < 0 ? -1.0f : 1.0f;
    ng = point.ng * side;
    ns = point.ns * side;
    terminator_normal = point.terminator_normal * side;
    wo = clamp_to_visible_side(frame.to_local(to_viewer), side);
}

Rgb irradiance(const SurfaceLight& light, const ShadingPoint& point) {
    if (is_own(light, point.surface)) return {};
    if (point.terminator_normal == point.ns) return surface_light_irradiance(light, point.surface.p, point.ns);
    return std::visit([&](const auto& shape) { return irradiance_above(light, shape, point); }, light.shape);
}

float LightVisibility::operator()(std::size_t light, const ShadingPoint& point) const {
    return shadows != nullptr ? shadows->visibility(light, point, taps) : 1;
}

DirectRadiance direct_light(std::span<const Light> lights, const DiffuseBsdf& bsdf, const ShadingPoint& point,
                            const LightVisibility& visibility) {
    DirectRadiance sum;
    if (is_black(bsdf.albedo)) return sum;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        Rgb light;
        if (const auto* surface = std::get_if<SurfaceLight>(&lights[i]))
            light = bsdf.albedo * kInvPi * irradiance(*surface, point);
        else if (const auto incident = delta_light(lights[i], point.surface.p))
            light = reflected(bsdf, point, *incident);
        if (!is_black(light)) sum.add(light, visibility(i, point));
    }
    return sum;
}

DirectRadiance direct_light(std::span<const Light> lights, const RoughDiffuseBsdf& bsdf, const ShadingPoint& point,
                            const LightVisibility& visibility) {
    DirectRadiance sum;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const auto* surface = std::get_if<SurfaceLight>(&lights[i]);
        if (surface != nullptr && is_own(*surface, point.surface)) continue;
        const auto incident = surface ? from_center(*surface, point.surface.p)
                                      : delta_light(lights[i], point.surface.p);
        if (!incident) continue;
        // The BSDF is evaluated for the direction to the light's center; the irradiance is integrated over the
        // surface light.
        Rgb light;
        if (surface != nullptr) {
            Vec3 wi = point.frame.to_local(incident->wi);
            // The center of a light that straddles the horizon may be below it.
            wi.z = std::abs(wi.z) * (point.wo.z < 0 ? -1.0f : 1.0f);
            light = bsdf.eval(point.wo, wi, TransportMode::kRadiance) * irradiance(*surface, point);
        } else {
            light = reflected(bsdf, point, *incident);
        }
        if (!is_black(light)) sum.add(light, visibility(i, point));
    }
    return sum;
}

DirectRadiance direct_light(std::span<const Light> lights, const MetalBsdf& bsdf, const ShadingPoint& point,
                            const LightVisibility& visibility, bool transformed_cosines) {
    DirectRadiance sum;
    if (bsdf.smooth()) return sum;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const auto* surface = std::get_if<SurfaceLight>(&lights[i]);
        if (surface != nullptr && is_own(*surface, point.surface)) continue;
        Rgb light;
        if (surface != nullptr && transformed_cosines)
            light = area_reflection(*surface, bsdf, point);
        else if (const auto incident =
                     surface ? from_center(*surface, point.surface.p) : delta_light(lights[i], point.surface.p))
            light = reflected(bsdf, point, *incident);
        if (!is_black(light)) sum.add(light, visibility(i, point));
    }
    return sum;
}

Incident as_distant(const SurfaceLight& light, Vec3 p) {
    return from_center(light, p).value_or(Incident{Vec3(0, 0, 1), Rgb()});
}

} // namespace duet::raster
