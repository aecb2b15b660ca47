// Indirect diffuse light of the environment and of other surfaces, from irradiance probes; what is nearer than the
// probes resolve is left to ambient occlusion.
#pragma once

#include "raster/gbuffer/gbuffer.h"
#include "raster/prepare.h"
#include "raster/probes/irradiance_probes.h"
#include "raster/screen_space/gtao.h"

namespace duet::raster {

/// Adds the light of the probes that diffuse surfaces reflect. `occlusion` may be null: nothing is hidden then.
void add_indirect_light(const Settings& settings, const GBuffer& gbuffer, const IrradianceProbes& probes,
                        const GtaoImage* occlusion, Planes3& radiance);

} // namespace duet::raster
