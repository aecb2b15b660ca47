#include "raytrace/denoise/patch_weights.h"

namespace duet::raytrace {

namespace {

// This is the width of a tile with the patches around its pixels, rounded up to whole batches.
constexpr int kAreaWidth = (DenoiseTile::kWidth + 2 * kPatchRadius + kBatchWidth - 1) / kBatchWidth * kBatchWidth;
constexpr int kAreaHeight = DenoiseTile::kHeight + 2 * kPatchRadius;

// Returns the squared difference of the pixels at (x, y) and at (x + dx, y + dy), summed over the channels. The
// variance of the noisier pixel is limited to that of the other one, because otherwise a firefly would resemble every
// pixel.
PixelBatch squared_distance(const Planes& color, const Planes& variance, int x, int y, int dx, int dy) {
    // The least variance distinguishes equal colors from others in noise-free regions. The largest distance is finite,
    // so that the mean of a patch is finite, too.
    const PixelBatch least_variance(1e-30f), largest(1e6f);
    PixelBatch sum(0.0f);
    for (std::size_t c = 0; c < 3; ++c) {
        const PixelBatch difference = color.load(c, x, y) - color.load(c, x + dx, y + dy);
        const PixelBatch own = variance.load(c, x, y), other = variance.load(c, x + dx, y + dy);
        const PixelBatch noise = own + xsimd::min(own, other);
        sum += xsimd::min((difference * difference - noise) / (own + other + least_variance), largest);
    }
    return sum;
}

template <typename Row> PixelBatch load_row(const Row& row, int i) {
    return PixelBatch::load_unaligned(&row[static_cast<std::size_t>(i)]);
}

} // namespace

void PatchWeights::compute(const DenoiseTile& tile, const HalfBuffers& halves, std::size_t filtered_half) {
    const Planes& color = halves.mean[1 - filtered_half];
    const Planes& variance = halves.variance[1 - filtered_half];
    const Planes& reliability = halves.reliability[filtered_half];
    std::array<std::array<float, kAreaWidth>, kAreaHeight> distances;
    std::array<float, kAreaWidth + kBatchWidth> column_sums{};
    const PixelBatch scale(-1.0f / (3 * kPatch * kPatch));
    std::size_t offset = 0;
    for (int dy = -kWindowRadius; dy <= kWindowRadius; ++dy)
        for (int dx = -kWindowRadius; dx <= kWindowRadius; ++dx, ++offset) {
            for (int j = 0; j < kAreaHeight; ++j)
                for (int i = 0; i < kAreaWidth; i += kBatchWidth) {
                    const int x = tile.x0 - kPatchRadius + i, y = tile.y0 - kPatchRadius + j;
                    const PixelBatch both_known = halves.known.load(0, x, y) * halves.known.load(0, x + dx, y + dy);
                    (squared_distance(color, variance, x, y, dx, dy) * both_known)
                        .store_unaligned(&distances[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)]);
                }
            for (int j = 0; j < DenoiseTile::kHeight; ++j) {
                for (int i = 0; i < kAreaWidth; i += kBatchWidth) {
                    PixelBatch sum(0.0f);
                    for (int k = 0; k < kPatch; ++k) sum += load_row(distances[static_cast<std::size_t>(j + k)], i);
                    sum.store_unaligned(&column_sums[static_cast<std::size_t>(i)]);
                }
                for (int i = 0; i < DenoiseTile::kWidth; i += kBatchWidth) {
                    PixelBatch sum(0.0f);
                    for (int k = 0; k < kPatch; ++k) sum += load_row(column_sums, i + k);
                    const PixelBatch weight = xsimd::exp(xsimd::min(sum * scale, PixelBatch(0.0f)));
                    (weight * reliability.load(0, tile.x0 + i + dx, tile.y0 + j + dy))
                        .store_unaligned(&weights_[index(offset, i, j)]);
                }
            }
        }
}

} // namespace duet::raytrace
