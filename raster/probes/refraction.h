// Glass: one look through two interfaces (Wyman 2005, "An Approximate Image-Space Approach for Interactive
// Refraction").
#pragma once

#include "raster/gbuffer/gbuffer.h"
#include "raster/raster_scene.h"

namespace duet::raster {

/// Adds the light that arrives through glass: refracted on entry, where the ray leaves the object (GlassShapes), and
/// then sampled in the object's reflection probe. Reflections are add_reflections()'s.
void add_refraction(const RasterSceneData& data, const RasterSettings& settings, const GBuffer& gbuffer,
                    Planes3& radiance);

} // namespace duet::raster
