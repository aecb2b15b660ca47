// Reflections on specular lobes and clear coats: what the lobe's direction sees, times the lobe's albedo, the split sum
// (Karis 2013, "Real Shading in Unreal Engine 4").
#pragma once

#include "raster/gbuffer/gbuffer.h"
#include "raster/raster_scene.h"

namespace duet::raster {

class ReflectionProbes; // raster/probes/reflection_probes.h

/// Adds what the surfaces reflect of their surroundings, without the lights' own light on rough surfaces, which is
/// direct light. Without probes the environment alone is reflected.
void add_reflections(const RasterSceneData& data, const RasterSettings& settings, const GBuffer& gbuffer,
                     const ReflectionProbes* probes, Planes3& radiance);

} // namespace duet::raster
