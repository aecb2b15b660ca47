// Computes sample positions in the pixel, on the lens and in time. They are the same for every pixel, because a pass
// draws one view of the whole scene.
#pragma once

#include "common/vec/vec.h"

#include <cstdint>
#include <vector>

namespace duet::raster {

/// Vertices and samples lie on one grid with 2^8 points per pixel and axis.
inline constexpr int kSubpixelBits = 8;
inline constexpr int kSubpixels = 1 << kSubpixelBits;

/// Stores the position of a sample in its pixel, in 1/256 pixel from the upper left corner; 0 to 256.
struct SampleOffset {
    std::int32_t x = kSubpixels / 2, y = kSubpixels / 2;

    bool operator==(const SampleOffset&) const = default;
    /// Returns the sample's pixel coordinates in pixel (column, row); exact.
    Vec2d position(int column, int row) const {
        return {column + static_cast<double>(x) / kSubpixels, row + static_cast<double>(y) / kSubpixels};
    }
};

/// Neighboring pixels use different taps or directions, so that few per pixel suffice. Pixels at this distance along
/// either axis use the same.
inline constexpr int kDitherSide = 4;
/// Returns a pixel's rank, 0 to 15, in a dither matrix of 4 × 4 pixels (Bayer 1973, "An Optimum Method for Two-Level
/// Rendition of Continuous-Tone Images"), so that the ranks of neighbors differ most.
inline std::uint32_t dither_rank(int x, int y) {
    const auto column = static_cast<std::uint32_t>(x), row = static_cast<std::uint32_t>(y), odd = column ^ row;
    return (odd & 1) << 3 | (row & 1) << 2 | (odd & 2) | (row & 2) >> 1;
}

/// Represents one view of the scene through one point of the lens at one time, with any number of samples per pixel.
struct Pass {
    Vec2d lens{0.5, 0.5}; ///< in [0, 1)²; (0.5, 0.5) is the lens center
    double time = 0;      ///< in [0, 1), relative to the shutter interval
    std::vector<SampleOffset> samples;
};

/// Returns the passes of an image with `count` >= 1 samples per pixel. All samples share one pass unless the view
/// has a lens or the scene moves; then each sample is a pass of its own. A single sample lies at the pixel center,
/// the lens center and the time the shutter opens. Several samples are points of Owen-scrambled (0,2)-sequences
/// (Sobol's first two dimensions; pixel, lens and time each have their own scramble and a shuffled order: Burley
/// 2020, "Practical Hash-based Owen Scrambling"), rounded to the grid. Sample i depends on (i, seed) only.
std::vector<Pass> plan_passes(int count, std::uint64_t seed, bool lens, bool motion);

} // namespace duet::raster
