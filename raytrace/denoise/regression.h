// Fits the colors of a window to its features by a first-order model (Bitterli et al. 2016, "Nonlinearly Weighted
// First-order Regression for Denoising Monte Carlo Renderings").
#pragma once

#include "raytrace/denoise/normal_equations.h"
#include "raytrace/denoise/patch_weights.h"

namespace duet::raytrace {

/// The weights of patches are raised to these powers. Each power is a filter of its own, with the bandwidths k = 1 and
/// k = 1/2 of non-local means. The second filter blurs less and leaves more noise. No third filter that was tried
/// gained more.
inline constexpr std::array<int, 2> kWeightPowers = {1, 4};
inline constexpr std::size_t kFilters = kWeightPowers.size();

/// Holds the models of some rows of the image. Plane 8·c + t of each filter holds the coefficient of term t in channel
/// c.
struct ModelRows {
    ModelRows(int width, int rows) : filters{Planes(width, rows, 3 * kTerms), Planes(width, rows, 3 * kTerms)} {}

    int first_row = 0; ///< row of the image that is row 0 of the planes
    std::array<Planes, kFilters> filters;
};

/// Fits a model around each pixel of a tile. `color` is the half that is filtered. Rows outside the image, or outside
/// the rows of `models`, are left out.
void fit_models(const DenoiseTile& tile, const PatchWeights& weights, const Planes& color, const Planes& features,
                ModelRows& models);

/// Evaluates at each pixel of a tile the models of all pixels in its window, and stores their weighted mean, less
/// `color`, in the planes of each filter. The mean of many models has less noise than one. If the weights of all other
/// pixels are 0, or all pixels with a weight have the same color, the result is exactly 0. Only rows before `rows` are
/// evaluated.
void evaluate_models(const DenoiseTile& tile, int rows, const PatchWeights& weights, const Planes& color,
                     const Planes& features, const ModelRows& models, std::array<Planes, kFilters>& correction);

} // namespace duet::raytrace
