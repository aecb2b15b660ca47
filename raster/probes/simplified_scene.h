// This header declares the scene that irradiance probes see, whose pixels are too coarse to show small triangles.
#pragma once

#include "raster/raster_scene.h"

#include <optional>

namespace duet::raster {

/// Returns a copy of the scene whose meshes of many small triangles are simplified to a detail of `cell` meters, or
/// nothing if there are no such meshes or `cell` is 0. Meshes of emissive and of masked or blended objects stay as they
/// are, and so do those of separate small parts, which would vanish.
std::optional<Scene> simplified_scene(const RasterSceneData& data, double cell);

} // namespace duet::raster
