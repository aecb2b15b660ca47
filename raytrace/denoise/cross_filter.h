// Declares the cross filter, which filters both halves of an image, each with weights from the other half.
#pragma once

#include "raytrace/denoise/regression.h"

namespace duet::raytrace {

/// Holds the change that each filter makes to each half: [half][filter].
using Corrections = std::array<std::array<Planes, kFilters>, 2>;

/// Filters both halves. Bands of rows are filtered one after the other, because the models of the whole image would
/// take 200 bytes per pixel. Threads filter tiles of a band; the result does not depend on their number.
Corrections cross_filter(const HalfBuffers& halves, const Planes& features, int threads);

} // namespace duet::raytrace
