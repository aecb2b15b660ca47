// Diffuse light of the environment: its irradiance by spherical harmonics, less what is hidden (Ramamoorthi and
// Hanrahan 2001, "An Efficient Representation for Irradiance Environment Maps").
#pragma once

#include "raster/gbuffer/gbuffer.h"
#include "raster/raster_scene.h"
#include "raster/screen_space/gtao.h"

namespace duet::raster {

/// Adds the light of the environment that diffuse surfaces reflect. `occlusion` may be null: nothing is hidden then.
void add_sky_light(const RasterSceneData& data, const RasterSettings& settings, const GBuffer& gbuffer,
                   const GtaoImage* occlusion, Planes3& radiance);

} // namespace duet::raster
