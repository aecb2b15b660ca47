// Renders glass by refracting each camera ray at two interfaces (Wyman 2005, "An Approximate Image-Space Approach for
// Interactive Refraction").
#pragma once

#include "raster/gbuffer/gbuffer.h"
#include "raster/raster_scene.h"

namespace duet::raster {

/// Adds the light that arrives through glass. The ray is refracted on entry and where it leaves the object
/// (GlassShapes), and then samples the object's reflection probe. add_reflections() adds the reflections.
void add_refraction(const RasterSceneData& data, const RasterSettings& settings, const GBuffer& gbuffer,
                    Planes3& radiance);

} // namespace duet::raster
