// The background: the environment's radiance where no surface is visible.
#pragma once

#include "raster/gbuffer/gbuffer.h"
#include "raster/raster_scene.h"

namespace duet::raster {

/// Sets the radiance of the pixels without a visible surface.
void draw_background(const RasterSceneData& data, const RasterSettings& settings, const GBuffer& gbuffer,
                     Planes3& radiance);

} // namespace duet::raster
