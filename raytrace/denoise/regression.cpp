#include "raytrace/denoise/regression.h"

namespace duet::raytrace {

namespace {

using Terms = NormalEquations::Terms;
using Color = NormalEquations::Color;

template <int power> PixelBatch raised(PixelBatch weight) {
    static_assert(power == 1 || power == 4);
    if constexpr (power == 1) return weight;
    const PixelBatch square = weight * weight;
    return square * square;
}

// Calls visit(offset, dx, dy) for all offsets of a window, in the order of PatchWeights.
template <typename Visit> void for_window(const Visit& visit) {
    std::size_t offset = 0;
    for (int dy = -kWindowRadius; dy <= kWindowRadius; ++dy)
        for (int dx = -kWindowRadius; dx <= kWindowRadius; ++dx) visit(offset++, dx, dy);
}

// Calls visit(x, y) for the batches of a tile from row `begin` up to row `end` of the image.
template <typename Visit> void for_batches(const DenoiseTile& tile, int width, int begin, int end, const Visit& visit) {
    for (int y = std::max(tile.y0, begin); y < std::min(tile.y0 + DenoiseTile::kHeight, end); ++y)
        for (int x = tile.x0; x < std::min(tile.x0 + DenoiseTile::kWidth, width); x += kBatchWidth) visit(x, y);
}

template <std::size_t count> std::array<PixelBatch, count> load_all(const Planes& planes, int x, int y) {
    std::array<PixelBatch, count> values;
    for (std::size_t i = 0; i < count; ++i) values[i] = planes.load(i, x, y);
    return values;
}

template <int power>
std::array<Terms, 3> fit(const DenoiseTile& tile, int x, int y, const PatchWeights& weights, const Planes& color,
                         const Planes& features) {
    const std::array<PixelBatch, kFeatures> center = load_all<kFeatures>(features, x, y);
    const Color center_color = load_all<3>(color, x, y);
    NormalEquations equations;
    for_window([&](std::size_t offset, int dx, int dy) {
        Terms terms;
        for (std::size_t f = 0; f < kFeatures; ++f) terms[f] = features.load(f, x + dx, y + dy) - center[f];
        terms[kFeatures] = PixelBatch(1.0f);
        Color difference;
        for (std::size_t c = 0; c < 3; ++c) difference[c] = color.load(c, x + dx, y + dy) - center_color[c];
        equations.add(raised<power>(weights.load(offset, x - tile.x0, y - tile.y0)), terms, difference);
    });
    return equations.solve();
}

template <std::size_t filter>
void fit_and_store(const DenoiseTile& tile, int x, int y, const PatchWeights& weights, const Planes& color,
                   const Planes& features, ModelRows& models) {
    const std::array<Terms, 3> model = fit<kWeightPowers[filter]>(tile, x, y, weights, color, features);
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t t = 0; t < kTerms; ++t)
            models.filters[filter].store(c * kTerms + t, x, y - models.first_row, model[c][t]);
}

template <std::size_t filter>
void evaluate(const DenoiseTile& tile, int x, int y, const PatchWeights& weights, const Planes& color,
              const Planes& features, const ModelRows& models, Planes& correction) {
    const Planes& coefficients = models.filters[filter];
    const std::array<PixelBatch, kFeatures> center = load_all<kFeatures>(features, x, y);
    const Color center_color = load_all<3>(color, x, y);
    Color sum{PixelBatch(0.0f), PixelBatch(0.0f), PixelBatch(0.0f)};
    PixelBatch total(0.0f);
    for_window([&](std::size_t offset, int dx, int dy) {
        const PixelBatch weight = raised<kWeightPowers[filter]>(weights.load(offset, x - tile.x0, y - tile.y0));
        const int model_y = y + dy - models.first_row;
        std::array<PixelBatch, kFeatures> difference;
        for (std::size_t f = 0; f < kFeatures; ++f) difference[f] = center[f] - features.load(f, x + dx, y + dy);
        for (std::size_t c = 0; c < 3; ++c) {
            PixelBatch value = color.load(c, x + dx, y + dy) - center_color[c] +
                               coefficients.load(c * kTerms + kFeatures, x + dx, model_y);
            for (std::size_t f = 0; f < kFeatures; ++f)
                value = multiply_add(coefficients.load(c * kTerms + f, x + dx, model_y), difference[f], value);
            sum[c] = multiply_add(weight, value, sum[c]);
        }
        total += weight;
    });
    const PixelBatch least(1e-30f);
    for (std::size_t c = 0; c < 3; ++c) correction.store(c, x, y, sum[c] / xsimd::max(total, least));
}

} // namespace

void fit_models(const DenoiseTile& tile, const PatchWeights& weights, const Planes& color, const Planes& features,
                ModelRows& models) {
    const int begin = std::max(models.first_row, 0);
    const int end = std::min(models.first_row + models.filters[0].height(), color.height());
    for_batches(tile, color.width(), begin, end, [&](int x, int y) {
        fit_and_store<0>(tile, x, y, weights, color, features, models);
        fit_and_store<1>(tile, x, y, weights, color, features, models);
    });
}

void evaluate_models(const DenoiseTile& tile, int rows, const PatchWeights& weights, const Planes& color,
                     const Planes& features, const ModelRows& models, std::array<Planes, kFilters>& correction) {
    for_batches(tile, color.width(), tile.y0, std::min(rows, color.height()), [&](int x, int y) {
        evaluate<0>(tile, x, y, weights, color, features, models, correction[0]);
        evaluate<1>(tile, x, y, weights, color, features, models, correction[1]);
    });
}

} // namespace duet::raytrace
