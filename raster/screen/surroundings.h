// This header declares the radiance along reflected and refracted rays that leave a point of the image.
#pragma once

#include "common/vec/box.h"
#include "raster/light/direct.h"
#include "raster/prepare.h"
#include "raster/screen/screen_reflection.h"

#include <cmath>

namespace duet::raster {

/// A look is a ray from a surface with the footprint of its lookup.
struct Look {
    Vec3 p; ///< ray origin, relative to the eye
    Vec3 n, way; ///< unit: the surface's normal on the ray's side; the ray's direction
    /// Width of the footprint at the origin, in meters; divergence in radians; a lens may make either negative.
    float width = 0, turn = 0;
    float spread = 0; ///< angle by which its blur grows, in radians
    float alpha = 0; ///< GGX alpha of the environment lookup
    bool lamps = true; ///< whether it sees emitters; for rough surfaces lights are direct light
    const ShadingPoint* point = nullptr; ///< the point that it leaves, where shadow maps are sampled for visible lights
    bool from_picture = true; ///< whether it starts on a visible surface
    bool mirrored_again = false; ///< by a metal sheet that it hit from behind

    /// Returns the width of the footprint at a distance, in meters.
    float size(float distance) const { return std::abs(width + distance * turn) + distance * spread; }
};

/// This is the greatest GGX alpha with screen-space reflections (roughness 0.54). The few rays of rougher metal are
/// so far apart that each would show object boundaries on a smooth surface.
inline constexpr float kRoughestMirror = 0.3f;

/// Returns the blur angle of a reflection in radians for GGX alpha: a slope deflects the ray by twice its angle, to
/// each side. alpha_as_wide is the inverse.
constexpr float blur_mirrored(float alpha) { return 4 * alpha; }
constexpr float alpha_as_wide(float spread) { return 0.25f * spread; }

/// Computes the radiance along a ray from the image and the scene's lists, without ray tracing. Its sources are the
/// visible surfaces (raster/screen/screen_reflection.h), the few lights at any position, and the environment as
/// background.
class Surroundings {
public:
    /// All arguments except `scenery` must outlive this object.
    Surroundings(const PreparedData& data, const Settings& settings, const Scenery& scenery);

    Rgb seen(const Look& look) const;

    /// PreparedData::lamps has at most this many lights; further ones are only visible in the image.
    static constexpr std::size_t kMostLamps = 256;

private:
    /// A light on a ray has a distance, the covered fraction of the footprint, and an index in Scene::lights.
    struct LampSeen {
        float distance = kInfinity, part = 0;
        std::size_t light = 0;
    };
    LampSeen nearest_lamp(const Look& look) const;
    /// `past_lamps` says that no light is on the ray, whatever the image's pixels show.
    Rgb picture_or_environment(const Look& look, bool past_lamps, float& distance) const;
    /// Returns the color of the visible surface at the hit.
    Rgb picture(const Look& look, const ScreenHit& hit, float& distance) const;
    std::optional<Rgb> behind_metal(const Look& look, const ScreenHit& hit) const;

    const PreparedData& data_;
    const Settings& settings_;
    Scenery scenery_;
    Box3 bounds_;
};

} // namespace duet::raster
