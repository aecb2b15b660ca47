// This header declares the unoccluded irradiance from the environment.
#pragma once

#include "raster/lighting/environment_sun.h"
#include "raster/lighting/spherical_harmonics.h"

namespace duet::raster {

/// Returns the coefficients of ∫ L(w) max(0, n·w) dw over all directions w, as a function of the unit normal n. They
/// are exact for constant environments and skies. An image is projected, which gives irradiance to within 1 % of its
/// mean for natural light (Ramamoorthi and Hanrahan 2001). A small bright sun has a larger error, up to 9 %, unless
/// `sun` replaces it; it may be null. The result is the same for any number of threads.
IrradianceHarmonics environment_irradiance(const Environment& environment, const EnvironmentSun* sun, int threads);

} // namespace duet::raster
