// The cross filter applies each filter to both halves of an image, each half with the weights of the other.
#pragma once

#include "raytrace/denoise/regression.h"

namespace duet::raytrace {

/// Holds what each filter adds to each half: [half][filter].
using Corrections = std::array<std::array<Planes, kFilters>, 2>;

/// Filters both halves. Bands of rows are filtered one after the other, because their models would take 200 bytes per
/// pixel. Each band is divided into tiles for the threads, on which no bit depends.
Corrections cross_filter(const HalfBuffers& halves, const Planes& features, int threads);

} // namespace duet::raytrace
