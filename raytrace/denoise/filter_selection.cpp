#include "raytrace/denoise/filter_selection.h"

#include "common/system/parallel.h"
#include "raytrace/denoise/box_filter.h"

namespace duet::raytrace {

namespace {

constexpr int kRadius = 6;
constexpr std::size_t kNoFilter = kFilters;

PixelBatch square(PixelBatch value) { return value * value; }

// Stores the error estimates of a batch of pixels, in one plane for each filter and one for the unfiltered image.
void estimate_errors(const HalfBuffers& halves, const Corrections& corrections, int x, int y, Planes& errors) {
    std::array<PixelBatch, kFilters + 1> sums;
    sums.fill(PixelBatch(0.0f));
    for (std::size_t c = 0; c < 3; ++c) {
        const PixelBatch a = halves.mean[0].load(c, x, y), b = halves.mean[1].load(c, x, y);
        const PixelBatch variance = halves.variance[0].load(c, x, y) + halves.variance[1].load(c, x, y);
        const PixelBatch smooth = a + b + corrections[0][0].load(c, x, y) + corrections[1][0].load(c, x, y);
        const PixelBatch scale = PixelBatch(1.0f) / (PixelBatch(0.25f) * square(smooth) + PixelBatch(0.01f));
        for (std::size_t k = 0; k < kFilters; ++k) {
            const PixelBatch filtered_a = a + corrections[0][k].load(c, x, y);
            const PixelBatch filtered_b = b + corrections[1][k].load(c, x, y);
            const PixelBatch of_halves = square(b - filtered_a) + square(a - filtered_b) - variance;
            sums[k] += scale * (PixelBatch(0.5f) * of_halves - PixelBatch(0.25f) * square(filtered_a - filtered_b));
        }
        sums[kNoFilter] += scale * PixelBatch(0.25f) * variance;
    }
    const PixelBatch known = halves.known.load(0, x, y);
    for (std::size_t k = 0; k <= kFilters; ++k) errors.store(k, x, y, sums[k] * known);
}

// Stores 1 for the filter with the least error and 0 for the other; both are 0 if the unfiltered image has the least
// error.
void choose(const Planes& errors, int x, int y, Planes& choices) {
    const PixelBatch wide = errors.load(0, x, y), narrow = errors.load(1, x, y), none = errors.load(kNoFilter, x, y);
    const PixelBatch zero(0.0f), one(1.0f);
    choices.store(0, x, y, xsimd::select(wide <= narrow && wide < none, one, zero));
    choices.store(1, x, y, xsimd::select(narrow < wide && narrow < none, one, zero));
}

// Moves a part of the unfiltered image's fraction to the narrow filter, in proportion to a firefly's unreliability.
void filter_fireflies(const HalfBuffers& halves, int x, int y, Planes& fractions) {
    const PixelBatch reliability = halves.reliability[0].load(0, x, y) * halves.reliability[1].load(0, x, y);
    const PixelBatch wide = fractions.load(0, x, y), narrow = fractions.load(1, x, y), one(1.0f);
    fractions.store(1, x, y, narrow + (one - wide - narrow) * (one - reliability));
}

} // namespace

Planes select_filters(const HalfBuffers& halves, const Corrections& corrections, int threads) {
    const int width = halves.known.width(), height = halves.known.height();
    const auto for_batches = [&](const auto& visit) {
        parallel_for(static_cast<std::size_t>(height), threads, [&](std::size_t y) {
            for (int x = 0; x < width; x += kBatchWidth) visit(x, static_cast<int>(y));
        });
    };
    Planes errors(width, height, kFilters + 1);
    for_batches([&](int x, int y) { estimate_errors(halves, corrections, x, y, errors); });
    errors = box_filter(std::move(errors), kRadius, threads);
    Planes choices(width, height, kFilters);
    for_batches([&](int x, int y) { choose(errors, x, y, choices); });
    Planes fractions = box_filter(std::move(choices), kRadius, threads);
    for_batches([&](int x, int y) { filter_fireflies(halves, x, y, fractions); });
    return fractions;
}

} // namespace duet::raytrace
