// Removes the noise of shadows that are estimated from few taps per pixel. The lit fraction is averaged over neighbors
// on the same surface, while the unshadowed light stays sharp (after Heitz, Hill and McGuire 2018, "Combining Analytic
// Direct Illumination and Stochastic Shadows"). The paper averages shadowed and unshadowed light and then divides. Here
// the fractions of all pixels have equal weight, because beside a darker texture the few taps of the brighter pixels
// would dominate.
#pragma once

#include "raster/lighting/direct_light.h"

namespace duet::raster {

/// Adds the direct light to the radiance. Noisy shadows are averaged over the 4 × 4 pixels whose taps differ
/// (SurfaceShadows).
void add_direct_light(const GBuffer& gbuffer, const DirectLight& light, int threads, Planes3& radiance);

} // namespace duet::raster
