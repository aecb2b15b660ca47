// This file defines the closed set of lights placed in the scene. The environment is in environment.h.
#pragma once

#include "common/geometry/shape.h"
#include "common/image/rgb.h"
#include "common/light/solid_angle.h"

#include <cstdint>
#include <optional>
#include <variant>

namespace duet {

/// A point light emits equally in all directions.
struct PointLight {
    Vec3 position;
    Rgb intensity; ///< W/sr
};
/// A spot light has full intensity within the inner angle and none beyond the outer angle. In between, the intensity
/// falls smoothly (3s² − 2s³ of the cosine). Angles are measured from the axis.
struct SpotLight {
    Vec3 position;
    Vec3 direction; ///< unit, direction of propagation
    Rgb intensity;  ///< W/sr on the axis
    float cos_inner = 1, cos_outer = 0;
};
/// A sun is a directional light at infinity.
struct SunLight {
    Vec3 direction; ///< unit, direction of propagation
    Rgb irradiance; ///< W/m² on a surface that faces it
};
/// A SurfaceLight is one primitive of an emissive surface, in world space. It does not move: a moving emitter has no
/// light samples and is found by BSDF sampling only.
struct SurfaceLight {
    using Triangle = LightTriangle;
    std::variant<Triangle, Quad, Sphere> shape; ///< front side: (b − a) × (c − a); u × v; outwards
    bool two_sided = false;
    Rgb radiance; ///< W/(m² sr)
    std::uint32_t object = 0, primitive = 0;
};
using Light = std::variant<PointLight, SpotLight, SunLight, SurfaceLight>;

/// A LightSample is the light that arrives at a point p from one direction, without occlusion.
struct LightSample {
    Vec3 wi;        ///< unit direction to the light
    float distance; ///< distance to the light; infinity for a sun
    /// This is the radiance that arrives from wi. For a delta light it is intensity / distance², or irradiance.
    Rgb radiance;
    float pdf;    ///< density by solid angle; 1 for a delta light
    bool delta;   ///< whether light comes from one direction only, which no BSDF sample finds
};
/// Draws a light sample for the point p with u in [0, 1)². The sample is empty where the light does not illuminate p
/// (behind the emitting side, outside the cone), or where u selects a degenerate point.
std::optional<LightSample> sample_light(const Light& light, Vec3 p, Vec2 u);
/// Returns the density, by solid angle at p, with which sample_light draws the direction to the point q of the light.
/// The density is 0 where the light does not emit toward p.
float light_pdf(const SurfaceLight& light, Vec3 p, Vec3 q);
/// Returns whether p lies on an emitting side. A point in a flat light's own plane does not.
bool emits_towards(const SurfaceLight& light, Vec3 p);
/// Returns the fraction of the axis's intensity at an angle of this cosine to the axis, in [0, 1]. T is float or a
/// batch of floats.
template <typename T> T spot_falloff(const SpotLight& light, T cosine) {
    const float range = max(light.cos_inner - light.cos_outer, 1e-12f); // equal angles give a hard edge
    const T s = clamp((cosine - T(light.cos_outer)) / T(range), T(0.0f), T(1.0f));
    return s * s * (T(3.0f) - T(2.0f) * s);
}
/// Returns the intensity in the unit direction w of propagation, in W/sr.
Rgb intensity(const SpotLight& light, Vec3 w);
/// Returns the area in m². Of a light with two sides, each has this area.
double area(const SurfaceLight& light);
/// Returns the emitted flux in W, averaged over channels. For a sun it is the flux through a disk of the scene's
/// radius.
float light_power(const Light& light, float scene_radius);
/// Returns whether the light emits nothing.
bool is_black(const Light& light);

} // namespace duet
