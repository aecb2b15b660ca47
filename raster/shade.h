// Stage 8: from a Hit to what the picture shows there, by the shared surface point, materials and lights.
#pragma once

#include "raster/prepare.h"
#include "raster/screen/screen.h"
#include "raster/visibility/cover.h"

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

} // namespace duet::raster
