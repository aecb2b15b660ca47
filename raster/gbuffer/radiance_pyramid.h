// This header declares a mip pyramid of an image, for wide lookups.
#pragma once

#include "common/image/image.h"

#include <vector>

namespace duet::raster {

/// Stores the means of 2 × 2, 4 × 4 … pixels (Williams 1983, "Pyramidal Parametrics").
class RadiancePyramid {
public:
    RadiancePyramid() = default;
    explicit RadiancePyramid(ImageRgb picture);
    /// Builds the pyramid from pixels with confidence `known`, in [0, 1]. Pixels below 1 are filled from known pixels
    /// nearby, with a weight that decreases with distance (pull-push, Gortler et al. 1996, "The Lumigraph", §3.4).
    /// The pyramid is empty if nothing is known. The result is bitwise equal for any number of threads.
    RadiancePyramid(ImageRgb picture, ImageFloat known, int threads);

    /// Returns the mean over about `width` pixels around (x, y), in pixels, interpolated trilinearly. Positions
    /// beyond the image's edge are clamped.
    Rgb at(float x, float y, float width) const;
    const ImageRgb& finest() const { return levels_.front(); }
    bool empty() const { return levels_.empty(); }
    std::size_t memory_bytes() const;

private:
    std::vector<ImageRgb> levels_;
};

} // namespace duet::raster
