// Stage 7: from a Hit to what the picture shows there, by the shared surface point, materials and lights.
#pragma once

#include "raster/cover.h"
#include "raster/prepare.h"
#include "raster/screen.h"

#include <optional>

namespace duet::raster {

/// What one sample gives to the picture and to the auxiliary pictures.
struct Shaded {
    Rgb radiance;
    Vec3 normal; ///< shading normal, on the viewer's side
    Rgb albedo;
};

/// Shades one sample of a tile as Shading::kLit; of another shading, whose colours come from its Program, it makes the
/// rest, with no radiance. Where nothing is hit, radiance is the environment's, or black where that is off or the
/// shading shows none. The albedo is filled in where the settings ask for it.
Shaded shade(const PreparedData& data, const Settings& settings, const HitTile& tile, int x, int y);

/// Whether shading by these settings looks at HitTile::screen.
bool needs_screen(const PreparedData& data, const Settings& settings);
/// Whether that must have its radiance, too, shaded by the same settings without reflections of it.
bool needs_screen_radiance(const PreparedData& data, const Settings& settings);
/// Whether that must have what there is without glass (Screen::behind).
bool needs_screen_behind(const PreparedData& data, const Settings& settings);
/// Whether that must have its occlusion.
bool needs_occlusion(const PreparedData& data, const Settings& settings);
/// Works it out, if so.
void add_occlusion(const PreparedData& data, const Settings& settings, Screen& screen);
/// Whether a material, somewhere, mirrors what the picture shows.
bool may_mirror(const Material& material);
/// Whether that is all that one of it shows: a first look at the picture knows of it but the environment.
bool is_mirror(const Material& material);
/// Settings::occlusion_radius, or what its 0 stands for.
double occlusion_radius(const PreparedData& data, const Settings& settings);

/// What is seen where nothing is, if it is the same everywhere.
std::optional<Rgb> constant_background(const PreparedData& data, const Settings& settings);

} // namespace duet::raster
