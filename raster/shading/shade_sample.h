// Implements stage 8, which shades a Hit with the shared surface point, materials and lights.
#pragma once

#include "raster/gbuffer/screen_gbuffer.h"
#include "raster/raster_scene.h"
#include "raster/visibility/hit_tile.h"

namespace duet::raster {

/// Holds the contributions of one sample to the image and to the auxiliary images.
struct ShadedSample {
    Rgb radiance;
    Vec3 normal; ///< shading normal on the viewer's side
    Rgb albedo;
};

/// Shades one sample of a tile for Shading::kLit. For the other shadings, whose colors come from a ShaderProgram, it
/// computes the other fields, and radiance is 0. On a miss, radiance is that of the environment, or black if the
/// environment is off or the shading does not show it. albedo is set only if the settings request it.
ShadedSample shade_sample(const RasterSceneData& data, const RasterSettings& settings, const HitTile& tile, int x,
                          int y);

} // namespace duet::raster
