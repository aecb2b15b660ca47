#include "common/sampling/distribution.h"

#include "common/system/error.h"
#include "common/vec/robust.h"

#include <algorithm>

namespace duet {

namespace {

/// Returns the float in [i/n, (i+1)/n) that is nearest to x. Rounding must not move a sample into a neighboring
/// interval, which has another density. The products are exact, because n is below 2^29.
float within_interval(double x, std::size_t i, std::size_t n) {
    float result = static_cast<float>(x);
    const double count = static_cast<double>(n), index = static_cast<double>(i);
    while (static_cast<double>(result) * count < index) result = next_up(result);
    while (static_cast<double>(result) * count >= index + 1) result = next_down(result);
    return result;
}

std::size_t interval_of(float x, std::size_t n) {
    const double scaled = static_cast<double>(x) * static_cast<double>(n);
    return scaled > 0 ? std::min(static_cast<std::size_t>(scaled), n - 1) : 0;
}

} // namespace

Distribution1D::Distribution1D(const std::vector<double>& values) {
    DUET_CHECK(!values.empty());
    const std::size_t n = values.size();
    cdf_.resize(n + 1);
    for (std::size_t i = 0; i < n; ++i) {
        DUET_CHECK(std::isfinite(values[i]) && values[i] >= 0);
        cdf_[i + 1] = cdf_[i] + values[i];
    }
    const double sum = cdf_[n];
    integral_ = sum / static_cast<double>(n);
    // The entry of the last positive value equals the sum, so this entry and all later ones become exactly 1.
    for (std::size_t i = 0; i <= n; ++i)
        cdf_[i] = sum > 0 ? cdf_[i] / sum : static_cast<double>(i) / static_cast<double>(n);
}

Distribution1D::Sample Distribution1D::sample(float u) const {
    // The first entry above u is the upper end of the interval. An interval of probability 0 is never selected, because
    // its two ends are equal.
    const double clamped_u = std::clamp(u, 0.0f, kOneMinusEpsilon);
    const auto above = std::upper_bound(cdf_.begin(), cdf_.end(), clamped_u);
    const auto i = static_cast<std::size_t>(above - cdf_.begin()) - 1;
    const double width = cdf_[i + 1] - cdf_[i];
    const double fraction = (clamped_u - cdf_[i]) / width;
    const double count = static_cast<double>(size());
    const float remapped = std::min(static_cast<float>(fraction), kOneMinusEpsilon);
    return {within_interval((static_cast<double>(i) + fraction) / count, i, size()), static_cast<float>(width * count),
            i, remapped};
}

float Distribution1D::pdf(float x) const {
    if (!(x >= 0 && x < 1) || size() == 0) return 0;
    const std::size_t i = interval_of(x, size());
    return static_cast<float>((cdf_[i + 1] - cdf_[i]) * static_cast<double>(size()));
}

float Distribution1D::probability(std::size_t i) const { return static_cast<float>(cdf_[i + 1] - cdf_[i]); }

Distribution2D::Distribution2D(const std::vector<double>& values, int width, int height) {
    DUET_CHECK_LT(0, width);
    DUET_CHECK_LT(0, height);
    const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
    DUET_CHECK_EQ(values.size(), w * h);
    rows_.reserve(h);
    std::vector<double> row(w), means(h);
    for (std::size_t y = 0; y < h; ++y) {
        std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(y * w), w, row.begin());
        rows_.emplace_back(row);
        means[y] = rows_[y].integral();
    }
    marginal_ = Distribution1D(means);
}

Distribution2D::Sample Distribution2D::sample(Vec2 u) const {
    const Distribution1D::Sample v = marginal_.sample(u.y);
    const Distribution1D::Sample x = rows_[v.index].sample(u.x);
    return {{x.x, v.x}, x.pdf * v.pdf};
}

float Distribution2D::pdf(Vec2 uv) const {
    if (!(uv.y >= 0 && uv.y < 1) || rows_.empty()) return 0;
    return rows_[interval_of(uv.y, rows_.size())].pdf(uv.x) * marginal_.pdf(uv.y);
}

} // namespace duet
