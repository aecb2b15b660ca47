// This header declares which visible surfaces are flat, and so are assumed to continue behind occluders.
#pragma once

#include "raster/screen/screen.h"

#include <cstdint>
#include <span>

namespace duet::raster {

/// Neighboring pixels of one surface differ in depth by at most this fraction of the depth.
inline constexpr float kSameSurface = 0.05f;
/// In radians: a larger turn is an edge rather than curvature. An isolated pixel also has this value.
inline constexpr float kSmallTurn = 0.5f;

/// Returns the largest angle in radians between the normal of pixel (x, y) and those of adjacent pixels on the same
/// surface. Reflected rays diverge by twice that angle. The screen's G-buffer must have object IDs. The result is
/// half a radian if no neighbor is on the same surface.
float normal_turn(const Screen& screen, int x, int y);
/// Returns the turns of all pixels for Screen::set_turns.
ImageFloat normal_turns(const Screen& screen, int threads);
/// Returns the radiance of flat surfaces and of the background from the color prepass (`first_look`), for
/// Screen::set_flat_look; the turns must be set. It is empty where there is neither. The background is included so
/// that the color changes gradually behind an occluder next to a flat surface's border; otherwise pixels at the
/// border flicker while the camera moves. Objects with a nonzero entry in `mirrors` are excluded, because the prepass
/// does not contain their reflections.
RadiancePyramid flat_look(const Screen& screen, std::span<const std::uint8_t> mirrors, int threads);

/// Returns whether the surface at a pixel is flat enough to continue as its plane. In a perspective view its radius of
/// curvature must exceed its depth, independent of the resolution. In an orthographic view it must exceed the height of
/// the view.
bool is_flat(const Screen& screen, int x, int y);

} // namespace duet::raster
