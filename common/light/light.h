// The closed set of lights that stand in the scene; the environment has a file of its own.
#pragma once

#include "common/geometry/shape.h"
#include "common/image/rgb.h"

#include <cstdint>
#include <optional>
#include <variant>

namespace duet {

struct PointLight {
    Vec3 position;
    Rgb intensity; ///< W/sr
};
/// Full intensity within `inner`, none beyond `outer`, smooth (3s² − 2s³ of the cosine) between; angles from the axis
/// in radians.
struct SpotLight {
    Vec3 position;
    Vec3 direction; ///< unit, the way the light goes
    Rgb intensity;  ///< W/sr on the axis
    float cos_inner = 1, cos_outer = 0;
};
/// Parallel light.
struct SunLight {
    Vec3 direction; ///< unit, the way the light goes
    Rgb irradiance; ///< W/m² on a surface that faces it
};
/// One primitive of an emissive surface, in the world; it does not move (a moving emitter is found by chance only).
struct SurfaceLight {
    struct Triangle {
        Vec3 a, b, c;
    };
    std::variant<Triangle, Quad, Sphere> shape; ///< front sides as in the scene: (b − a) × (c − a); u × v; outwards
    bool two_sided = false;
    Rgb radiance; ///< W/(m² sr)
    std::uint32_t object = 0, primitive = 0;
};
using Light = std::variant<PointLight, SpotLight, SunLight, SurfaceLight>;

/// Light that could arrive at p, visibility left out.
struct LightSample {
    Vec3 wi;        ///< unit, to the light
    float distance; ///< infinity for the sun
    Rgb radiance; ///< arriving from wi: radiance for a surface; intensity / distance² or irradiance for a delta light
    float pdf;    ///< by solid angle; 1 for a delta light
    bool delta;   ///< from one direction only: found by no BSDF sample
};
/// Empty where the light cannot reach p (behind the emitting side, outside the cone) or u falls on a degenerate spot.
std::optional<LightSample> sample_light(const Light& light, Vec3 p, Vec2 u);
/// The density (by solid angle at p) with which sample_light returns the direction in which `q` lies on
/// the light. 0 where the light does not emit towards p.
float light_pdf(const SurfaceLight& light, Vec3 p, Vec3 q);
/// Whether p lies on an emitting side; no point of a flat light's own plane does.
bool emits_towards(const SurfaceLight& light, Vec3 p);
/// Emitted flux, W, averaged over channels (of a sun: on a disk of the scene's radius), for choosing among lights.
float light_power(const Light& light, float scene_radius);
bool is_delta(const Light& light);

} // namespace duet
