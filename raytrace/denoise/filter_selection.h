// Declares the filter selection, which decides by cross-validation how strongly each pixel is filtered.
#pragma once

#include "raytrace/denoise/cross_filter.h"

namespace duet::raytrace {

/// Returns the fraction with which each filter (one plane each) is applied at each pixel. The unfiltered image has the
/// remaining fraction. It is a candidate, too, so that the bias of the filters vanishes with the noise.
///
/// The squared error of a filtered half is estimated from the other half, whose noise is independent: it is the squared
/// difference of both, less the variance of the other half (Bitterli et al. 2016, section 5.3). The mean of both
/// filtered halves has an error that is lower by the square of half their difference. These estimates are noisy, and
/// are averaged over a square around the pixel, relative to its brightness. Then the candidate with the least error is
/// chosen, and the choices are averaged, so that there are no seams. The unfiltered fraction of a firefly is at most
/// its reliability.
Planes select_filters(const HalfBuffers& halves, const Corrections& corrections, int threads);

} // namespace duet::raytrace
