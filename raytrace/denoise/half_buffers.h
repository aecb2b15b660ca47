// HalfBuffers are the color of a film as the denoiser reads it: two independent halves, and how noisy they are.
#pragma once

#include "raytrace/denoise/planes.h"
#include "raytrace/film/film.h"

#include <array>

namespace duet::raytrace {

/// Holds the means of a film's two replicates, and the variances of these means.
struct HalfBuffers {
    HalfBuffers(int width, int height)
        : mean{Planes(width, height, 3), Planes(width, height, 3)}, variance{Planes(width, height, 3),
                                                                             Planes(width, height, 3)},
          known(width, height, 1), reliability{Planes(width, height, 1), Planes(width, height, 1)} {}

    std::array<Planes, 2> mean;        ///< red, green, blue
    std::array<Planes, 2> variance;    ///< of `mean`
    Planes known;                      ///< 1 where both halves have a sample; 0 elsewhere and outside of the image
    std::array<Planes, 2> reliability; ///< weight in [0, 1] of a pixel for others: below 1 for fireflies; 0 if unknown
};

/// Reads the halves of a film.
///
/// The difference of the halves estimates the variance of one sample with one degree of freedom, which is too few to
/// compare pixels by it. It is therefore averaged over 5 × 5 pixels.
///
/// A firefly is so bright that its half alone says nothing of its neighbors. A pixel that is more than twice as bright
/// as the other half, and as all neighbors in both halves, counts for others in inverse proportion to its brightness.
/// What both halves contain counts in full, so that this bias vanishes with more samples.
HalfBuffers half_buffers(const Film& film, int threads);

} // namespace duet::raytrace
