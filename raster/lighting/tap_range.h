// Defines the subset of an effect's sampling points that one sample uses.
#pragma once

namespace duet::raster {

/// Selects from a fixed set of points on a light those that a receiver samples: all of them, or one of four blocks if
/// a pixel has several samples that share the work.
struct TapRange {
    static constexpr int kBlocks = 4, kBlock = 16;
    int first = 0, count = kBlocks * kBlock;

    /// Returns the block for the quadrant of the pixel in which a sample lies. The first four points of a
    /// (0,2)-sequence cover all four quadrants.
    static TapRange of_quadrant(int quadrant) { return {quadrant * kBlock, kBlock}; }
};

} // namespace duet::raster
