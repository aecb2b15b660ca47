// This header declares which prepasses (raster/gbuffer/screen_gbuffer.h) shading with given settings needs.
#pragma once

#include "raster/raster_scene.h"

namespace duet::raster {

/// Returns whether shading uses HitTile::gbuffer.
bool needs_screen_gbuffer(const RasterSceneData& data, const RasterSettings& settings);
/// Returns whether the G-buffer must have radiance, shaded by the same settings without screen-space reflections.
bool needs_color_prepass(const RasterSceneData& data, const RasterSettings& settings);
/// Returns whether the G-buffer needs the scene without glass (ScreenGBuffer::behind).
bool needs_glass_layers(const RasterSceneData& data, const RasterSettings& settings);
/// Returns whether the G-buffer needs ambient occlusion.
bool needs_occlusion(const RasterSceneData& data, const RasterSettings& settings);
/// Returns RasterSettings::occlusion_radius, or the default radius if that is 0, in meters.
double occlusion_radius(const RasterSceneData& data, const RasterSettings& settings);

} // namespace duet::raster
