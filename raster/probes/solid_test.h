// Tests whether a point lies inside a solid object, where a probe would see nothing of the scene.
#pragma once

#include "raster/raster_scene.h"

namespace duet::raster {

/// Returns whether the world-space point lies inside a closed object: a sphere, a box of quads or a closed mesh.
bool inside_solid(const RasterSceneData& data, Vec3d p);

} // namespace duet::raster
