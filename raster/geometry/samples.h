// Where samples lie: in the pixel, on the lens and in time. The same for every pixel, for a pass draws one view of the
// whole scene.
#pragma once

#include "common/vec/vec.h"

#include <cstdint>
#include <vector>

namespace duet::raster {

/// Vertices and samples lie on one grid of 2^8 points a pixel and axis.
inline constexpr int kSubPixelBits = 8;
inline constexpr int kSubPixels = 1 << kSubPixelBits;

/// A sample's place in its pixel, in 1/256 pixel from the upper left corner: 0 to 256.
struct SampleOffset {
    std::int32_t x = kSubPixels / 2, y = kSubPixels / 2;

    bool operator==(const SampleOffset&) const = default;
    /// The sample's pixel coordinates in the pixel (column, row); exact.
    Vec2d position(int column, int row) const {
        return {column + static_cast<double>(x) / kSubPixels, row + static_cast<double>(y) / kSubPixels};
    }
};

/// One view of the scene: through one point of the lens, at one moment, with any number of samples a pixel.
struct Pass {
    Vec2d lens{0.5, 0.5}; ///< in [0, 1)², the lens's centre at (0.5, 0.5)
    double time = 0;      ///< in [0, 1) of the shutter interval
    std::vector<SampleOffset> samples;
};

/// The passes of a picture of `count` >= 1 samples a pixel. All samples share one pass unless the view has a lens or
/// the scene moves, when each is a pass of its own. A single sample is the pixel's centre, the lens's centre and the
/// opening of the shutter. More are points of Owen-scrambled (0,2)-sequences (Sobol's first two dimensions; the pixel,
/// the lens and the time each have a scramble of their own and a shuffled order: Burley 2020, «Practical Hash-based
/// Owen Scrambling»), rounded to the grid. Sample i is a function of (i, seed) alone.
std::vector<Pass> plan_passes(int count, std::uint64_t seed, bool lens, bool motion);

} // namespace duet::raster
