// Indirect diffuse light of the environment and of other surfaces, from irradiance probes; what is nearer than the
// probes resolve is left to ambient occlusion.
#pragma once

#include "raster/fog/fog_grid.h"
#include "raster/gbuffer/gbuffer.h"
#include "raster/probes/irradiance_probes.h"
#include "raster/raster_scene.h"
#include "raster/screen_space/gtao.h"

namespace duet::raster {

/// Returns the light that fog scatters besides that of lights: what irradiance probes see, else the environment.
AmbientLight ambient_light(const RasterSceneData& data, const RasterSettings& settings,
                           const ScreenProjection& projection);

/// Adds the light of the probes that diffuse surfaces reflect, at every pixel and without occlusion.
void add_indirect_light(const RasterSettings& settings, const GBuffer& gbuffer, const IrradianceProbes& probes,
                        Planes3& radiance);
/// The same at half resolution, with the occlusion that `half` holds; it receives the irradiance.
void add_indirect_light(const RasterSettings& settings, const GBuffer& gbuffer, const IrradianceProbes& probes,
                        GtaoImage& half, Planes3& radiance);

} // namespace duet::raster
