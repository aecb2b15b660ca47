// Declares HalfBuffers, the denoiser's view of a film: two independent halves of its color, and their noise.
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
    std::array<Planes, 2> variance;    ///< variance of `mean`
    Planes known;                      ///< 1 where both halves have a sample; 0 elsewhere and outside of the image
    std::array<Planes, 2> reliability; ///< weight in [0, 1] for other pixels: below 1 for fireflies; 0 if unknown
};

/// Reads the halves of a film.
///
/// The difference of the halves estimates the variance of one sample, but with a single degree of freedom, which is too
/// noisy to compare pixels. The estimate is therefore averaged over 5 × 5 pixels.
///
/// A firefly is so bright in one half that it carries no information about its neighbors. If a pixel is more than twice
/// as bright as in the other half and as all neighbors in both halves, its weight for other pixels is inversely
/// proportional to its brightness. Brightness that both halves contain keeps its full weight, so this bias vanishes
/// with more samples.
HalfBuffers half_buffers(const Film& film, int threads);

} // namespace duet::raytrace
