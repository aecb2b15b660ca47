#include "raster/gbuffer/radiance_pyramid.h"

#include "common/system/parallel.h"
#include "raster/gbuffer/bilinear.h"

#include <algorithm>
#include <cmath>

namespace duet::raster {
namespace {

/// Runs small levels on one thread, because starting threads would cost more than the work.
template <typename F> void for_rows(const ImageRgb& image, int threads, const F& visit) {
    const auto rows = static_cast<std::size_t>(image.height());
    parallel_for(rows, image.size() < 10000 ? 1 : threads, [&](std::size_t y) { visit(static_cast<int>(y)); });
}

/// Computes row y of a coarse level as the weighted mean of two rows of the fine level. Uncertain pixels lose half of
/// their weight per level.
void pull(const ImageRgb& fine, const ImageFloat& fine_weights, int y, ImageRgb& coarse, ImageFloat& coarse_weights) {
    for (int row = 2 * y; row < std::min(2 * y + 2, fine.height()); ++row)
        for (int x = 0; x < fine.width(); ++x) {
            coarse(x / 2, y) += fine(x, row) * fine_weights(x, row);
            coarse_weights(x / 2, y) += fine_weights(x, row);
        }
    for (int x = 0; x < coarse.width(); ++x) {
        float& weight = coarse_weights(x, y);
        if (weight > 0) coarse(x, y) = coarse(x, y) / weight;
        weight = 0;
        for (int row = 2 * y; row < std::min(2 * y + 2, fine.height()); ++row)
            for (int i = 2 * x; i < std::min(2 * x + 2, fine.width()); ++i)
                weight = std::max(weight, fine_weights(i, row));
        if (weight < 1) weight *= 0.5f;
    }
}

/// Fills the unknown pixels in row y of a fine level from the coarse level.
void push(const ImageRgb& coarse, const ImageFloat& fine_weights, int y, ImageRgb& fine) {
    for (int x = 0; x < fine.width(); ++x)
        if (const float weight = fine_weights(x, y); weight < 1) {
            const Rgb about = bilinear(coarse, 0.5f * (static_cast<float>(x) + 0.5f),
                                       0.5f * (static_cast<float>(y) + 0.5f));
            fine(x, y) = weight > 0 ? lerp(about, fine(x, y), weight) : about;
        }
}

} // namespace

RadiancePyramid::RadiancePyramid(ImageRgb picture) {
    levels_.push_back(std::move(picture));
    while (std::min(levels_.back().width(), levels_.back().height()) > 1) {
        const ImageRgb& fine = levels_.back();
        ImageRgb coarse((fine.width() + 1) / 2, (fine.height() + 1) / 2);
        for (int y = 0; y < coarse.height(); ++y)
            for (int x = 0; x < coarse.width(); ++x) {
                const int left = 2 * x, right = std::min(left + 1, fine.width() - 1), top = 2 * y,
                          bottom = std::min(top + 1, fine.height() - 1);
                coarse(x, y) = (fine(left, top) + fine(right, top) + fine(left, bottom) + fine(right, bottom)) * 0.25f;
            }
        levels_.push_back(std::move(coarse));
    }
}

RadiancePyramid::RadiancePyramid(ImageRgb picture, ImageFloat known, int threads) {
    std::vector<ImageFloat> weights;
    weights.push_back(std::move(known));
    levels_.push_back(std::move(picture));
    while (levels_.back().width() > 1 || levels_.back().height() > 1) {
        ImageRgb coarse((levels_.back().width() + 1) / 2, (levels_.back().height() + 1) / 2);
        ImageFloat coarse_weights(coarse.width(), coarse.height());
        for_rows(coarse, threads, [&](int y) { pull(levels_.back(), weights.back(), y, coarse, coarse_weights); });
        levels_.push_back(std::move(coarse)), weights.push_back(std::move(coarse_weights));
    }
    if (!(weights.back()[0] > 0)) {
        levels_.clear();
        return;
    }
    for (std::size_t i = levels_.size() - 1; i-- > 0;)
        for_rows(levels_[i], threads, [&](int y) { push(levels_[i + 1], weights[i], y, levels_[i]); });
}

Rgb RadiancePyramid::at(float x, float y, float width) const {
    const float level = clamp(std::log2(max(width, 1.0f)), 0.0f, static_cast<float>(levels_.size() - 1));
    const auto low = static_cast<std::size_t>(level), high = std::min(low + 1, levels_.size() - 1);
    const auto of = [&](std::size_t i) {
        const float scale = 1 / static_cast<float>(1u << i);
        return bilinear(levels_[i], x * scale, y * scale);
    };
    const float part = level - static_cast<float>(low);
    return part > 0 ? lerp(of(low), of(high), part) : of(low);
}

std::size_t RadiancePyramid::memory_bytes() const {
    std::size_t count = 0;
    for (const ImageRgb& level : levels_) count += level.size();
    return count * sizeof(Rgb);
}

} // namespace duet::raster
