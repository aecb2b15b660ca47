// Adds indirect diffuse light of the environment and of other surfaces from irradiance probes. Ambient occlusion
// accounts for occluders that are too near for the probes to resolve, and for the light that these send.
#pragma once

#include "raster/fog/fog_grid.h"
#include "raster/gbuffer/gbuffer.h"
#include "raster/probes/irradiance_probes.h"
#include "raster/raster_scene.h"
#include "raster/screen_space/gtao.h"

namespace duet::raster {

/// Returns the radiance that fog scatters besides that of Scene::lights: that of irradiance probes if there are any,
/// else that of the environment.
AmbientLight ambient_light(const RasterSceneData& data, const RasterSettings& settings,
                           const ScreenProjection& projection);

/// Adds the light of the probes that diffuse surfaces reflect. It is interpolated at every pixel, without occlusion.
void add_indirect_light(const RasterSettings& settings, const GBuffer& gbuffer, const IrradianceProbes& probes,
                        Planes3& radiance);
/// Adds the light of the probes as interpolated at half resolution, without what occluders hide, and the light of the
/// occluders. `half` holds both after GtaoImage::find_light().
void add_indirect_light(const RasterSettings& settings, const GBuffer& gbuffer, const IrradianceProbes& probes,
                        const GtaoImage& half, Planes3& radiance);

} // namespace duet::raster
