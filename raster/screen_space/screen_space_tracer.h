// This header declares the radiance along reflected and refracted rays that leave a point of the image.
#pragma once

#include "common/vec/box.h"
#include "raster/lighting/direct_lighting.h"
#include "raster/raster_scene.h"
#include "raster/screen_space/ray_march.h"

#include <cmath>

namespace duet::raster {

/// A cone is a ray from a surface with the footprint of its lookup.
struct RayCone {
    Vec3 p;            ///< ray origin, relative to the eye
    Vec3 n, direction; ///< unit: the surface's normal on the ray's side; the ray's direction
    /// Width of the footprint at the origin, in meters; divergence in radians; a lens may make either negative.
    float width = 0, divergence = 0;
    float spread = 0;                    ///< angle by which its blur grows, in radians
    float alpha = 0;                     ///< GGX alpha of the environment lookup
    bool include_lights = true;          ///< whether it sees emitters; for rough surfaces lights are direct light
    const ShadingPoint* point = nullptr; ///< the point that it leaves, where shadow maps are sampled for visible lights
    bool from_visible_surface = true;    ///< whether it starts on a visible surface
    bool second_reflection = false;      ///< by a metal sheet that it hit from behind

    /// Returns the width of the footprint at a distance, in meters.
    float size(float distance) const { return std::abs(width + distance * divergence) + distance * spread; }
};

/// This is the greatest GGX alpha with screen-space reflections (roughness 0.54). The few rays of rougher metal are
/// so far apart that each would show object boundaries on a smooth surface.
inline constexpr float kMaxReflectionAlpha = 0.3f;

/// Returns the blur angle of a reflection in radians for GGX alpha: a slope deflects the ray by twice its angle, to
/// each side. blur_to_alpha is the inverse.
constexpr float reflection_blur(float alpha) { return 4 * alpha; }
constexpr float blur_to_alpha(float spread) { return 0.25f * spread; }

/// Computes the radiance along a ray from the image and the scene's lists, without ray tracing. Its sources are
/// the visible surfaces (raster/screen_space/ray_march.h), the few lights at any position, and the environment as
/// background.
class ScreenSpaceTracer {
public:
    /// All arguments except `source` must outlive this object.
    ScreenSpaceTracer(const RasterSceneData& data, const RasterSettings& settings, const ReflectionSource& source);

    Rgb incoming_radiance(const RayCone& cone) const;

    /// RasterSceneData::reflected_lights has at most this many lights; further ones are only visible in the image.
    static constexpr std::size_t kMaxReflectedLights = 256;

private:
    /// A light on a ray has a distance, the covered fraction of the footprint, and an index in Scene::lights.
    struct LightHit {
        float distance = kInfinity, fraction = 0;
        std::size_t light = 0;
    };
    LightHit nearest_light(const RayCone& cone) const;
    /// `ignore_lights` says that no light is on the ray, whatever the image's pixels show.
    Rgb image_or_environment(const RayCone& cone, bool ignore_lights, float& distance) const;
    /// Returns the color of the visible surface at the hit.
    Rgb image_color(const RayCone& cone, const ScreenHit& hit, float& distance) const;
    std::optional<Rgb> reflection_behind_metal(const RayCone& cone, const ScreenHit& hit) const;

    const RasterSceneData& data_;
    const RasterSettings& settings_;
    ReflectionSource source_;
    Box3 bounds_;
};

} // namespace duet::raster
