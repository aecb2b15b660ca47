// Declares the denoiser, which estimates an image from the noisy halves of its film and from features. It uses
// regression on features, weighted by non-local means, with cross-validated error (Bitterli et al. 2016).
#pragma once

#include "common/image/image.h"
#include "raytrace/denoise/planes.h"
#include "raytrace/film/film.h"

namespace duet::raytrace {

/// Returns the denoised image of a film. `features` are those of trace_features. Pixels in which a half has no valid
/// sample are returned as they are, and so is an image in which both halves are equal, bit for bit. The result is
/// finite and not negative. It does not depend on the number of threads (0: all).
ImageRgb denoise(const Film& film, const Planes& features, int threads);

} // namespace duet::raytrace
