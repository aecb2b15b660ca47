#include "compare/metrics/ssim.h"

#include "common/system/parallel.h"
#include "compare/metrics/same_size.h"

#include <array>
#include <cmath>

namespace duet::compare {

namespace {

constexpr int kWindow = 11;
using Window = std::array<double, kWindow>;

Window gaussian_window() {
    Window window{};
    double sum = 0;
    for (int i = 0; i < kWindow; ++i) sum += window[static_cast<std::size_t>(i)] = std::exp(-sqr((i - 5) / 1.5) / 2);
    for (double& weight : window) weight /= sum;
    return window;
}

/// Holds weighted means and central moments over a window or a part of one, which are merged without cancellation
/// (Chan, Golub and LeVeque 1979, "Updating Formulae and a Pairwise Algorithm for Computing Sample Variances").
struct Moments {
    double a = 0, b = 0;            ///< means
    double aa = 0, bb = 0, ab = 0;  ///< weighted sums of products of deviations from the means
    double weight = 0;

    void add(double w, const Moments& m) {
        const double total = weight + w, da = m.a - a, db = m.b - b, between = weight * w / total;
        aa += w * m.aa + between * da * da;
        bb += w * m.bb + between * db * db;
        ab += w * m.ab + between * da * db;
        a += da * (w / total);
        b += db * (w / total);
        weight = total;
    }
};

double similarity(const Moments& m) {
    constexpr double kC1 = 0.01 * 0.01, kC2 = 0.03 * 0.03;
    return (2 * m.a * m.b + kC1) * (2 * m.ab + kC2) / ((m.a * m.a + m.b * m.b + kC1) * (m.aa + m.bb + kC2));
}

struct Sum {
    double value = 0;
    std::int64_t count = 0;
};

/// Returns the sum and the number of the similarities of all windows of one channel whose top row is y.
Sum row_of_windows(const ImageRgb& a, const ImageRgb& b, int y, std::size_t channel, const Window& window) {
    std::vector<Moments> columns(static_cast<std::size_t>(a.width()));
    for (int k = 0; k < kWindow; ++k)
        for (int x = 0; x < a.width(); ++x) {
            const double va = static_cast<double>(a(x, y + k)[channel]), vb = static_cast<double>(b(x, y + k)[channel]);
            columns[static_cast<std::size_t>(x)].add(window[static_cast<std::size_t>(k)],
                                                     {.a = va, .b = vb});
        }
    Sum sum;
    for (std::size_t x = 0; x + kWindow <= columns.size(); ++x) {
        Moments moments;
        for (std::size_t k = 0; k < kWindow; ++k) moments.add(window[k], columns[x + k]);
        const double value = similarity(moments);
        if (!std::isfinite(value)) continue;
        sum.value += value;
        ++sum.count;
    }
    return sum;
}

} // namespace

double ssim(const ImageRgb& a, const ImageRgb& b, int threads) {
    check_same_size(a, b);
    const Window window = gaussian_window();
    std::vector<std::array<Sum, 3>> rows(static_cast<std::size_t>(std::max(a.height() - kWindow + 1, 0)));
    parallel_for(rows.size(), threads, [&](std::size_t y) {
        for (std::size_t c = 0; c < 3; ++c) rows[y][c] = row_of_windows(a, b, static_cast<int>(y), c, window);
    });
    Sum total;
    for (const auto& row : rows)
        for (const Sum& sum : row) {
            total.value += sum.value;
            total.count += sum.count;
        }
    return total.value / static_cast<double>(total.count); // 0 / 0 gives NaN, as documented
}

} // namespace duet::compare
