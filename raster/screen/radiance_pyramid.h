// A picture at half its size again and again: what a wide look at it sees.
#pragma once

#include "common/image/image.h"

#include <vector>

namespace duet::raster {

/// Means of 2 × 2, 4 × 4 … pixels (Williams 1983, «Pyramidal Parametrics»).
class RadiancePyramid {
public:
    RadiancePyramid() = default;
    explicit RadiancePyramid(ImageRgb picture);
    /// Of pixels by how well they are `known`, in [0, 1]; those of less than 1 are filled from what is known about them
    /// (Gortler et al. 1996, «The Lumigraph», §3.4: pull and push), and count the less the farther off it is that is filled.
    /// Empty where nothing is known. The same bits for any number of threads.
    RadiancePyramid(ImageRgb picture, ImageFloat known, int threads);

    /// About (x, y), in pixels, over about `width` of them: between levels and between pixels linearly. At the picture's
    /// edge what is there goes on.
    Rgb at(float x, float y, float width) const;
    const ImageRgb& finest() const { return levels_.front(); }
    bool empty() const { return levels_.empty(); }
    std::size_t memory_bytes() const;

private:
    std::vector<ImageRgb> levels_;
};

} // namespace duet::raster
