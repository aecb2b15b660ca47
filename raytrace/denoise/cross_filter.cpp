#include "raytrace/denoise/cross_filter.h"

#include "common/system/parallel.h"

namespace duet::raytrace {

namespace {

// The models of a band of rows are fitted up to a window's radius beyond the band, and in whole tiles.
constexpr int kModelRows = 8 * DenoiseTile::kHeight;
constexpr int kBandRows = kModelRows - 2 * kWindowRadius;

// Computes the weights of all tiles of some rows, and calls visit(tile, weights).
template <typename Visit>
void for_tiles(const HalfBuffers& halves, std::size_t half, int first_row, int end_row, int threads,
               const Visit& visit) {
    constexpr int kTilesInTask = 4; // tiles share the memory of the weights
    const int columns = (halves.known.width() + DenoiseTile::kWidth - 1) / DenoiseTile::kWidth;
    const int rows = (end_row - first_row + DenoiseTile::kHeight - 1) / DenoiseTile::kHeight;
    const int tiles = columns * rows;
    parallel_for(static_cast<std::size_t>((tiles + kTilesInTask - 1) / kTilesInTask), threads, [&](std::size_t task) {
        PatchWeights weights;
        const int first = static_cast<int>(task) * kTilesInTask;
        for (int i = first; i < std::min(first + kTilesInTask, tiles); ++i) {
            const DenoiseTile tile{i % columns * DenoiseTile::kWidth, first_row + i / columns * DenoiseTile::kHeight};
            weights.compute(tile, halves, half);
            visit(tile, weights);
        }
    });
}

} // namespace

Corrections cross_filter(const HalfBuffers& halves, const Planes& features, int threads) {
    const int width = features.width(), height = features.height();
    const Planes none(width, height, 3);
    Corrections corrections{std::array{none, none}, std::array{none, none}};
    ModelRows models(width, kModelRows);
    for (int first = 0; first < height; first += kBandRows)
        for (std::size_t half = 0; half < 2; ++half) {
            const Planes& color = halves.mean[half];
            models.first_row = first - kWindowRadius;
            const int end = std::min(first + kBandRows, height);
            for_tiles(halves, half, models.first_row, end + kWindowRadius, threads,
                      [&](const DenoiseTile& tile, const PatchWeights& weights) {
                          fit_models(tile, weights, color, features, models);
                      });
            for_tiles(halves, half, first, end, threads, [&](const DenoiseTile& tile, const PatchWeights& weights) {
                evaluate_models(tile, end, weights, color, features, models, corrections[half]);
            });
        }
    return corrections;
}

} // namespace duet::raytrace
