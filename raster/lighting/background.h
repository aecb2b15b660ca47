// Draws the background, which is the environment's radiance where no surface is visible.
#pragma once

#include "raster/gbuffer/gbuffer.h"
#include "raster/raster_scene.h"

namespace duet::raster {

/// Returns whether the settings show the scene's environment.
bool shows_environment(const RasterSceneData& data, const RasterSettings& settings);
/// Returns whether nothing emits light, so that the image is black.
bool is_dark(const RasterSceneData& data, const RasterSettings& settings);

/// Sets the radiance in `image` of the pixels without a visible surface: that of the environment, with or without its
/// sun.
void draw_background(const RasterSceneData& data, const RasterSettings& settings, const GBuffer& gbuffer, bool sun,
                     Planes3& image);

} // namespace duet::raster
