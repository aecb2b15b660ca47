// What shading by some settings asks of a look at the picture beforehand (raster/screen/screen.h).
#pragma once

#include "raster/prepare.h"

namespace duet::raster {

/// Whether shading looks at HitTile::screen.
bool needs_screen(const PreparedData& data, const Settings& settings);
/// Whether that must have its radiance, too, shaded by the same settings without reflections of it.
bool needs_screen_radiance(const PreparedData& data, const Settings& settings);
/// Whether that must have what there is without glass (Screen::behind).
bool needs_screen_behind(const PreparedData& data, const Settings& settings);
/// Whether that must have its occlusion.
bool needs_occlusion(const PreparedData& data, const Settings& settings);
/// Settings::occlusion_radius, or what its 0 stands for.
double occlusion_radius(const PreparedData& data, const Settings& settings);

} // namespace duet::raster
