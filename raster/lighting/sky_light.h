// Computes diffuse light of the environment: its irradiance by spherical harmonics, without occluded directions
// (Ramamoorthi and Hanrahan 2001, "An Efficient Representation for Irradiance Environment Maps").
#pragma once

#include "raster/gbuffer/gbuffer.h"
#include "raster/raster_scene.h"
#include "raster/screen_space/gtao.h"

namespace duet::raster {

/// Adds the environment's light that diffuse surfaces reflect. If `occlusion` is null, nothing is occluded.
void add_sky_light(const RasterSceneData& data, const RasterSettings& settings, const GBuffer& gbuffer,
                   const GtaoImage* occlusion, Planes3& radiance);

} // namespace duet::raster
