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

/// Sets the irradiance of `half` from the probes. Afterwards, GtaoImage::find_light() searches for the occluders that
/// the probes do not resolve, up to occluder_reach() meters away.
void interpolate_probes(const RasterSettings& settings, const GBuffer& gbuffer, const IrradianceProbes& probes,
                        GtaoImage& half);
/// Returns 0 without ambient occlusion.
float occluder_reach(const RasterSettings& settings, const IrradianceProbes& probes);
/// Adds the light that diffuse surfaces reflect: that of `half`, and that of the probes where `half` has none.
void add_indirect_light(const RasterSettings& settings, const GBuffer& gbuffer, const IrradianceProbes& probes,
                        const GtaoImage& half, Planes3& radiance);

} // namespace duet::raster
