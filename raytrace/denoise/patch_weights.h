// Declares PatchWeights, which compares patches of pixels in the way of non-local means (Buades et al. 2005, "A
// Non-Local Algorithm for Image Denoising").
#pragma once

#include "raytrace/denoise/half_buffers.h"

#include <vector>

namespace duet::raytrace {

/// Represents the part of the image that one thread filters. The last tiles extend into the border.
struct DenoiseTile {
    static constexpr int kWidth = 32, kHeight = 16;
    int x0, y0;
};

/// A pixel is compared with all pixels in a window of this radius. A larger window finds more pixels that are similar
/// by chance: with a radius of 7, cornell.json has 1.2 times the squared error at 4 samples per pixel.
inline constexpr int kWindowRadius = 5;
inline constexpr int kWindow = 2 * kWindowRadius + 1;

/// Two pixels are compared by the square patches around them. A larger patch distinguishes noise from detail more
/// reliably, but a patch that contains an edge resembles fewer others, and noise remains around the edge.
inline constexpr int kPatchRadius = 2;
inline constexpr int kPatch = 2 * kPatchRadius + 1;

/// Holds the weights of all pixels in the windows around a tile's pixels.
class PatchWeights {
public:
    PatchWeights() : weights_(kOffsets * DenoiseTile::kWidth * DenoiseTile::kHeight) {}

    /// Computes the weights with which one half of the image is filtered, from the colors of the other half. The
    /// weights are therefore independent of the noise that they average; weights from the same half would darken the
    /// image. The weight of q for p is exp(−d²) times the reliability of q. Here d² is the mean squared difference of
    /// the patches, less the expected effect of noise, over the sum of their variances (Rousselle et al. 2012,
    /// "Adaptive Rendering with Non-Local Means Filtering", equation 3).
    void compute(const DenoiseTile& tile, const HalfBuffers& halves, std::size_t filtered_half);

    /// Returns the weights of the pixels at an offset from the batch of pixels at (x, y) of the tile. Offsets are
    /// numbered row by row, from (−kWindowRadius, −kWindowRadius) on.
    PixelBatch load(std::size_t offset, int x, int y) const {
        return PixelBatch::load_unaligned(&weights_[index(offset, x, y)]);
    }

private:
    static constexpr std::size_t kOffsets = std::size_t{kWindow} * kWindow;
    // The weights of a batch of pixels are adjacent in memory, because the regression reads them together.
    static std::size_t index(std::size_t offset, int x, int y) {
        const auto batch = static_cast<std::size_t>(y * DenoiseTile::kWidth + x) / kMaxSimdLanes;
        return (batch * kOffsets + offset) * kMaxSimdLanes;
    }

    std::vector<float, HugePageAllocator<float>> weights_;
};

} // namespace duet::raytrace
