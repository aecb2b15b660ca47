// Adds reflections on specular lobes and clear coats by the split sum: the radiance in the lobe's direction times the
// lobe's albedo (Karis 2013, "Real Shading in Unreal Engine 4").
#pragma once

#include "raster/gbuffer/gbuffer.h"
#include "raster/raster_scene.h"

namespace duet::raster {

class ReflectionProbes; // raster/probes/reflection_probes.h

/// Adds the light that the surfaces reflect from their surroundings. Reflections of lights on rough surfaces are left
/// out, because they are direct light. Without probes, only the environment is reflected.
void add_reflections(const RasterSceneData& data, const RasterSettings& settings, const GBuffer& gbuffer,
                     const ReflectionProbes* probes, Planes3& radiance);

} // namespace duet::raster
