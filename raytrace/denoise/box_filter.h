// Declares the box filter, which computes the mean over a square around each pixel.
#pragma once

#include "raytrace/denoise/planes.h"

namespace duet::raytrace {

/// Returns the mean of each plane over the (2·radius + 1)² pixels around each pixel. Beyond the edge of the image, the
/// nearest pixels are repeated. The result has no border; extend_to_border() provides it. `radius` is at most half of
/// Planes::kBorder.
Planes box_filter(Planes planes, int radius, int threads);

} // namespace duet::raytrace
