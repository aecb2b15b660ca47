// What a ray sees that leaves a point of the picture: of mirrors and of glass.
#pragma once

#include "common/vec/box.h"
#include "raster/light/direct.h"
#include "raster/prepare.h"
#include "raster/screen/screen_reflection.h"

#include <cmath>

namespace duet::raster {

/// A ray from a surface, and how wide a look it stands for.
struct Look {
    Vec3 p;                   ///< where it begins, relative to the eye
    Vec3 n, way;              ///< unit: the surface's normal on the ray's side; the ray's direction
    float width = 0, turn = 0; ///< of the look where it begins, metres; by how much its two sides part, radians, which a
                               ///< lens may have meet: either may be negative
    float spread = 0;         ///< by which its blur grows, radians
    float alpha = 0;          ///< GGX alpha by which an environment is blurred
    bool lamps = true;        ///< whether it sees what shines: to rough surfaces lamps are direct light
    const ShadingPoint* point = nullptr; ///< that it leaves, where shadow maps tell which lamps that sees
    bool from_picture = true; ///< whether it begins at what the screen shows
    bool mirrored_again = false; ///< by a sheet of metal that it has met from behind

    /// Of the look, metres.
    float size(float distance) const { return std::abs(width + distance * turn) + distance * spread; }
};

/// GGX alpha up to which metal mirrors what the picture shows (roughness 0.54): of rougher metal the few rays are so far apart
/// that each shows on a smooth surface where it goes from one thing to the next.
inline constexpr float kRoughestMirror = 0.3f;

/// By how much GGX alpha spreads a mirrored look, radians: slopes turn it by 2, to each side. And the other way round.
constexpr float blur_mirrored(float alpha) { return 4 * alpha; }
constexpr float alpha_as_wide(float spread) { return 0.25f * spread; }

/// What a picture and the scene's lists know without tracing a ray through its surfaces: what the picture shows
/// (raster/screen/screen_reflection.h); lamps, which are few, wherever they stand; the environment behind all.
class Surroundings {
public:
    /// Refers to all, but the scenery.
    Surroundings(const PreparedData& data, const Settings& settings, const Scenery& scenery);

    Rgb seen(const Look& look) const;

    static constexpr std::size_t kMostLamps = 256; ///< PreparedData::lamps: of more, the others are seen in the picture alone

private:
    /// A lamp that a ray meets: how far off, how much of its look that fills, and which of Scene::lights.
    struct LampSeen {
        float distance = kInfinity, part = 0;
        std::size_t light = 0;
    };
    LampSeen nearest_lamp(const Look& look) const;
    /// `past_lamps`: no lamp is on the way, whatever the picture's pixels show of one.
    Rgb picture_or_environment(const Look& look, bool past_lamps, float& distance) const;
    Rgb picture(const Look& look, const ScreenHit& hit, float& distance) const; ///< What it shows where it is met.
    std::optional<Rgb> behind_metal(const Look& look, const ScreenHit& hit) const;

    const PreparedData& data_;
    const Settings& settings_;
    Scenery scenery_;
    Box3 bounds_;
};

} // namespace duet::raster
