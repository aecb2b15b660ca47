// What metal and glass see of the scene, as far as the picture shows it.
#pragma once

#include "common/geometry/hit.h"
#include "common/vec/box.h"
#include "raster/screen/flat_look.h"

#include <algorithm>
#include <optional>

namespace duet::raster {

/// What an object sees of a picture: the picture, but where it is itself in the way what is behind it.
struct Scenery {
    const Screen& all;                 ///< with a first look
    const Screen* without = nullptr;   ///< the same view with the first surface of each pixel gone; null: nothing sees through
    std::uint32_t object = kNoObject;  ///< that looks

    bool is_own(int x, int y) const { return all.first_look().objects(x, y) == object; }
    const Screen& at(int x, int y) const { return without != nullptr && is_own(x, y) ? *without : all; }
    /// Of a look at `width` pixels about a place how many see its object alone, one at least.
    float width_within(float x, float y, float width) const;
    /// Whether a place's pixel and four about it, so far along each axis, show one object.
    bool one_object(float x, float y, float reach) const;
    /// Whether a look so far about a place sees, in a mirror, the mirror itself: the first look does not know what that shows.
    bool own_within(float x, float y, float reach) const;
    /// Of a look at `width` pixels about a place how many do not, one at least; all where the place itself is on it.
    float width_beside_own(float x, float y, float width) const;
    /// The one for a look at some pixels about a place, in which it must not see itself.
    const Screen& about(float x, float y, float width) const {
        const float reach = std::max(1.0f, 0.5f * width);
        for (const float dx : {-reach, 0.0f, reach})
            for (const float dy : {-reach, 0.0f, reach}) {
                const auto [column, row] = all.pixel_at({x + dx, y + dy, 0});
                if (const Screen& screen = at(column, row); &screen != &all) return screen;
            }
        return all;
    }
};

/// Where a ray from a point of the picture meets what the picture shows.
struct ScreenHit {
    float x, y;     ///< in pixels
    float distance; ///< from the point, metres
    float gap = 0;  ///< metres from what that pixel sees to what is met, where that is but guessed to be alike; of the hidden more
    bool hidden = false; ///< what is met is no part of what is seen there, but of a flat surface about it (flat_look)
};

/// A ray to be followed through the picture.
struct ScreenRay {
    Vec3 p;                   ///< relative to the eye, in the picture or beside it
    Vec3 n, way;              ///< unit: its surface's normal; its direction
    bool from_picture = true; ///< p is on what the picture shows there, which the ray cannot meet at once
    bool past_lamps = false;  ///< lamps that rays look for (Screen::FirstLook::lamps) are not met: it is known that none is on the way
};

/// Follows a ray through the picture, pixel by pixel (McGuire and Mara 2014, «Efficient GPU Screen-Space Ray Tracing»),
/// until it goes behind what is seen there. A closed thing is met from behind, too: it is as thick as its nearest back face says
/// (Screen::thickness), and what it shows of itself stands for its far side. Of another the picture does not say how
/// thick it is: one that the ray passes farther behind than it is itself deep over two pixels, or kThickness of its depth, is
/// taken to be passed.
///
/// What the picture does not show it may still tell of. A flat surface that the ray, when it comes out from behind
/// something, has already crossed by its plane is what it has met there; one that it was last seen before goes on behind
/// what hides the ray. Hidden up to its own end, where no edge of the picture cuts it off, it goes on past that to the
/// first flat surface whose plane it crosses, or to what is behind all; else the picture's edge stands for what it meets.
/// Flat surfaces go on beyond the edge, up to the bounds of the scene (relative to the eye): what the edge shows where the ray
/// leaves, or, where that is the mirror itself or is not met, what is seen along the edge and has not ended where it would
/// be met. Where that is behind something round it is looked up at its own place, which the flat look fills from all sides.
/// Lamps do not go on. Glass that the ray comes through towards the viewer is not met: what that shows the viewer it does not
/// show the ray. Empty where the ray meets nothing so.
std::optional<ScreenHit> trace_screen(const Scenery& scenery, const Box3& scene, const ScreenRay& ray);

inline constexpr float kThickness = 0.02f; ///< of the depth: of what is not closed, as thick it is taken to be at least
/// What is guessed is seen no sharper than the guess is good: blurred by as much of ScreenHit::gap.
inline constexpr float kGuessBlur = 0.25f;

} // namespace duet::raster
