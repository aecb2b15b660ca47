// This header declares which prepasses (raster/screen/screen.h) shading with given settings needs.
#pragma once

#include "raster/prepare.h"

namespace duet::raster {

/// Returns whether shading uses HitTile::screen.
bool needs_screen(const PreparedData& data, const Settings& settings);
/// Returns whether the screen must have radiance, shaded by the same settings without screen-space reflections.
bool needs_screen_radiance(const PreparedData& data, const Settings& settings);
/// Returns whether the screen needs the scene without glass (Screen::behind).
bool needs_screen_behind(const PreparedData& data, const Settings& settings);
/// Returns whether the screen needs ambient occlusion.
bool needs_occlusion(const PreparedData& data, const Settings& settings);
/// Returns Settings::occlusion_radius, or the default radius if that is 0, in meters.
double occlusion_radius(const PreparedData& data, const Settings& settings);

} // namespace duet::raster
