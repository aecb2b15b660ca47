#include "raytrace/denoise/cross_filter.h"

#include "common/system/parallel.h"

namespace duet::raytrace {

namespace {

// The models of a band reach beyond it by a window's radius, and fill whole tiles.
constexpr int kModelRows = 8 * DenoiseTile::kHeight;
constexpr int kBandRows = kModelRows - 2 * kWindowRadius;

template <typename Visit>
void for_tiles(int width, int first_row, int end_row, int threads, const Visit& visit) {
    const int columns = (width + DenoiseTile::kWidth - 1) / DenoiseTile::kWidth;
    const int rows = (end_row - first_row + DenoiseTile::kHeight - 1) / DenoiseTile::kHeight;
    parallel_for(static_cast<std::size_t>(columns * rows), threads, [&](std::size_t i) {
        const int tile = static_cast<int>(i);
        visit(DenoiseTile{tile % columns * DenoiseTile::kWidth, first_row + tile / columns * DenoiseTile::kHeight});
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
            for_tiles(width, models.first_row, std::min(end, height) + kWindowRadius, threads,
                      [&](const DenoiseTile& tile) {
                          PatchWeights weights;
                          weights.compute(tile, halves, half);
                          fit_models(tile, weights, color, features, models);
                      });
            for_tiles(width, first, end, threads, [&](const DenoiseTile& tile) {
                PatchWeights weights;
                weights.compute(tile, halves, half);
                evaluate_models(tile, end, weights, color, features, models, corrections[half]);
            });
        }
    return corrections;
}

} // namespace duet::raytrace
