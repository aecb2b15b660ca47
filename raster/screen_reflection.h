// What metal mirrors of the scene, as far as the picture shows it.
#pragma once

#include "raster/screen.h"

#include <optional>

namespace duet::raster {

/// Where a ray from a point of the picture meets what the picture shows.
struct ScreenHit {
    int x, y; ///< pixel
};

/// Follows a ray through the picture, pixel by pixel (McGuire and Mara 2014, «Efficient GPU Screen-Space Ray Tracing»),
/// until it goes behind what is seen there. `p` is relative to the eye; n, its surface's unit normal, and `way`, are
/// unit. The picture does not say how thick things are: one that the ray passes farther behind than it is itself deep
/// over two pixels, or kThickness of its depth, is taken to be passed. Empty where the ray leaves the picture, comes
/// towards the eye out of it, or meets nothing.
std::optional<ScreenHit> trace_screen(const Screen& screen, Vec3 p, Vec3 n, Vec3 way);

inline constexpr float kThickness = 0.02f;

} // namespace duet::raster
