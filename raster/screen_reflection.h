// What metal mirrors of the scene, as far as the picture shows it.
#pragma once

#include "common/vec/box.h"
#include "raster/screen.h"

#include <optional>

namespace duet::raster {

/// Where a ray from a point of the picture meets what the picture shows.
struct ScreenHit {
    float x, y;     ///< in pixels
    float distance; ///< from the point, metres
    float gap = 0;  ///< metres from what is seen at that pixel to what is met, where that is only guessed to be alike
};

/// Follows a ray through the picture, pixel by pixel (McGuire and Mara 2014, «Efficient GPU Screen-Space Ray Tracing»),
/// until it goes behind what is seen there. `p` is relative to the eye; n, its surface's unit normal, and `way`, are
/// unit. The picture does not say how thick things are: one that the ray passes farther behind than it is itself deep
/// over two pixels, or kThickness of its depth, is taken to be passed.
///
/// What the picture does not show it may still tell of. A flat surface that the ray, when it comes out from behind
/// something, has already crossed by its plane is what it has met there; one that it was last seen before goes on behind
/// what hides the ray up to the picture's edge, which stands for what it meets where there is none; and surfaces go on beyond the edge as they are there, up to the bounds of the scene (relative
/// to the eye). Empty where the ray meets nothing so.
///
/// `from_picture`: p is on what the picture shows there, which the ray cannot meet at once.
std::optional<ScreenHit> trace_screen(const Screen& screen, const Box3& scene, Vec3 p, Vec3 n, Vec3 way, bool from_picture = true);

/// By how much the normal turns from pixel (x, y), seen at p (relative to the eye), to the next one on its surface,
/// radians at most: twice that is what a mirror's rays spread by.
float normal_turn(const Screen& screen, int x, int y);

inline constexpr float kThickness = 0.02f;

} // namespace duet::raster
