// Removes the noise of shadows that few taps a pixel estimate: the fraction of light that arrives is averaged over
// neighbors on the same surface, while the unshadowed light stays sharp (Heitz, Hill and McGuire 2018, "Combining
// Analytic Direct Illumination and Stochastic Shadows"). They average both lights and divide then. Here each pixel
// counts alike instead: beside a darker texture the brighter pixels' few taps would outweigh the others.
#pragma once

#include "raster/lighting/direct_light.h"

namespace duet::raster {

/// Adds the direct light to the radiance, noisy shadows averaged over the 4 × 4 pixels whose taps differ (MapShadows).
void add_direct_light(const GBuffer& gbuffer, const DirectLight& light, int threads, Planes3& radiance);

} // namespace duet::raster
