// What is nearest in any part of a shadow map or of a screen's depths, without looking at all of it.
#pragma once

#include "common/image/image.h"

#include <algorithm>
#include <vector>

namespace duet::raster {

/// The greatest numbers of an image in blocks of 2 × 2, 4 × 4 … pixels (Greene, Kass and Miller 1993, «Hierarchical
/// Z-Buffer Visibility», §3).
class NearestPyramid {
public:
    explicit NearestPyramid(ImageFloat image);

    /// At least the greatest number in columns x0 to x1 and rows y0 to y1, all within the image; at most the greatest
    /// in a region of four blocks around them.
    float greatest(int x0, int y0, int x1, int y1) const;
    /// The greatest number of a pixel's block of 2^level × 2^level pixels, or, where there are none so large, of the whole image.
    float of_block(int x, int y, int level) const {
        level = std::min(level, static_cast<int>(levels_.size()) - 1);
        return levels_[static_cast<std::size_t>(level)](x >> level, y >> level);
    }
    /// Of the whole image.
    float greatest() const { return levels_.back()[0]; }
    /// The greatest number of each block of 2^level × 2^level pixels, level 0 or more; the last level has one block.
    const ImageFloat& level(int level) const { return levels_[static_cast<std::size_t>(level)]; }
    std::int64_t memory_bytes() const;

private:
    std::vector<ImageFloat> levels_; ///< the image, then blocks of 2, 4, 8 …
};

} // namespace duet::raster
