// Which points a sample looks at, of those that an effect has for a pixel.
#pragma once

namespace duet::raster {

/// Which of a fixed set of points on a light a receiver looks at: all, or, where a pixel has several samples that take
/// turns, one of four blocks of them.
struct TapRange {
    static constexpr int kBlocks = 4, kBlock = 16;
    int first = 0, count = kBlocks * kBlock;

    /// The block of a sample by the quadrant of the pixel it lies in: the first four of a (0,2)-sequence have all four.
    static TapRange of_quadrant(int quadrant) { return {quadrant * kBlock, kBlock}; }
};

} // namespace duet::raster
