// Implements a maximum pyramid of reversed depths (Hi-Z) for shadow maps and screen-space depths.
#pragma once

#include "common/image/image.h"

#include <algorithm>
#include <vector>

namespace duet::raster {

/// Holds the maxima of an image over blocks of 2 × 2, 4 × 4 … pixels (Greene, Kass and Miller 1993, "Hierarchical
/// Z-Buffer Visibility", §3).
class HiZPyramid {
public:
    explicit HiZPyramid(ImageFloat image);

    /// Returns an upper bound of the values in columns x0 to x1 and rows y0 to y1 (inclusive, within the image).
    /// The bound is at most the maximum over a region of four blocks that contains them.
    float max_over(int x0, int y0, int x1, int y1) const;
    /// Returns the maximum of the block of 2^level × 2^level pixels that contains the pixel. Larger levels than the
    /// pyramid has return the maximum of the whole image.
    float block_max(int x, int y, int level) const {
        level = std::min(level, static_cast<int>(levels_.size()) - 1);
        return levels_[static_cast<std::size_t>(level)](x >> level, y >> level);
    }
    /// Returns the maximum of the whole image.
    float max_over() const { return levels_.back()[0]; }
    /// Returns the maxima of all blocks of 2^level × 2^level pixels. `level` is from 0 to the last level, which has
    /// one block.
    const ImageFloat& level(int level) const { return levels_[static_cast<std::size_t>(level)]; }
    std::int64_t memory_bytes() const;

private:
    std::vector<ImageFloat> levels_; ///< the image, then blocks of side 2, 4, 8 …
};

} // namespace duet::raster
