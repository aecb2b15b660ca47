#include "raster/radiance_pyramid.h"

#include "raster/bilinear.h"

#include <algorithm>
#include <cmath>

namespace duet::raster {

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

RadiancePyramid::RadiancePyramid(ImageRgb picture, const Image<std::uint8_t>& known) {
    std::vector<ImageFloat> weights{ImageFloat(known.width(), known.height())};
    for (std::size_t i = 0; i < known.size(); ++i) weights[0][i] = known[i] != 0 ? 1.0f : 0.0f;
    levels_.push_back(std::move(picture));
    while (levels_.back().width() > 1 || levels_.back().height() > 1) {
        const ImageRgb& fine = levels_.back();
        const ImageFloat& fine_weights = weights.back();
        ImageRgb coarse((fine.width() + 1) / 2, (fine.height() + 1) / 2);
        ImageFloat coarse_weights(coarse.width(), coarse.height());
        for (int y = 0; y < fine.height(); ++y)
            for (int x = 0; x < fine.width(); ++x) {
                coarse(x / 2, y / 2) += fine(x, y) * fine_weights(x, y);
                coarse_weights(x / 2, y / 2) += fine_weights(x, y);
            }
        for (std::size_t i = 0; i < coarse.size(); ++i) {
            if (coarse_weights[i] > 0) coarse[i] = coarse[i] / coarse_weights[i];
            coarse_weights[i] = std::min(coarse_weights[i], 1.0f);
        }
        levels_.push_back(std::move(coarse)), weights.push_back(std::move(coarse_weights));
    }
    if (!(weights.back()[0] > 0)) {
        levels_.clear();
        return;
    }
    for (std::size_t i = levels_.size() - 1; i-- > 0;)
        for (int y = 0; y < levels_[i].height(); ++y)
            for (int x = 0; x < levels_[i].width(); ++x)
                if (const float weight = weights[i](x, y); weight < 1) {
                    const Rgb about = bilinear(levels_[i + 1], 0.5f * (static_cast<float>(x) + 0.5f), 0.5f * (static_cast<float>(y) + 0.5f));
                    levels_[i](x, y) = weight > 0 ? lerp(about, levels_[i](x, y), weight) : about;
                }
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
