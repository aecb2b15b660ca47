// Which of what a picture shows is flat, and goes on behind what stands before it.
#pragma once

#include "raster/screen/screen.h"

#include <cstdint>
#include <span>

namespace duet::raster {

inline constexpr float kSameSurface = 0.05f; ///< of the depth: how far neighbouring pixels of one surface may be apart
inline constexpr float kSmallTurn = 0.5f;    ///< radians: a sharper edge is not a curve; and of a pixel alone

/// By how much the normal turns from pixel (x, y) to the next one on its surface, radians at most, of a screen that knows its
/// objects: twice that is what a mirror's rays spread by. Half a radian where no neighbour is of its surface.
float normal_turn(const Screen& screen, int x, int y);
/// Of all pixels: Screen::set_turns.
ImageFloat normal_turns(const Screen& screen, int threads);
/// Screen::set_flat_look: the first look at flat surfaces and past all surfaces, the turns being known. Empty where there is
/// neither. What lies behind all is a part of it, that where a flat surface ends what is hidden beside its edge changes
/// gradually: else it is all surface up to there, and a pixel at the edge flickers while the camera moves. Objects that are
/// `mirrors`, not 0, are none of it: the first look does not know what they show.
RadiancePyramid flat_look(const Screen& screen, std::span<const std::uint8_t> mirrors, int threads);

/// Whether what a pixel shows goes on as its plane does: its radius of curvature is more than its depth, however fine the
/// picture; or, seen from infinitely far, than what the picture shows is high.
bool is_flat(const Screen& screen, int x, int y);

} // namespace duet::raster
