// This header declares the linearly transformed cosines that approximate the GGX reflection lobe, by roughness and
// angle. Area lights on rough metal use them.
#pragma once

#include "raster/lighting/lobe_matrix.h"

namespace duet::raster {

/// Looks up the lobe in a table that is computed when the project is built (raster/lighting/ggx_fit.h). alpha is in (0,
/// 1]; values below (1/20)² are clamped to that. `cosine`, between normal and viewer, is in (0, 1].
LobeMatrix ggx_lobe(float alpha, float cosine);

} // namespace duet::raster
