// Computes the values of the auxiliary images for one sample, with the shared surface point and materials.
#pragma once

#include "raster/raster_scene.h"
#include "raster/visibility/hit_tile.h"

namespace duet::raster {

/// Holds the contributions of one sample to the image and to the auxiliary images.
struct ShadedSample {
    Rgb radiance;
    Vec3 normal; ///< shading normal on the viewer's side
    Rgb albedo;
};

/// Returns the normal of one sample of a tile and, if the settings request it, the albedo. The radiance is 0. On a
/// miss, all values are 0.
ShadedSample sample_attributes(const RasterSceneData& data, const RasterSettings& settings, const HitTile& tile, int x,
                               int y);

} // namespace duet::raster
