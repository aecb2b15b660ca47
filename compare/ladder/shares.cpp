#include "compare/ladder/shares.h"

#include "common/image/srgb.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

namespace duet::compare {

namespace {

double product(Rgbd a, Rgbd b) { return a.r * b.r + a.g * b.g + a.b * b.b; }

/// Returns Δ_k of one pixel and half. Here k counts from 0.
Rgbd change(const LadderImages& images, std::size_t half, std::size_t k, std::size_t pixel) {
    const auto& steps = images.halves[half];
    return Rgbd(k == 0 ? images.first[pixel] : steps[k - 1][pixel]) - Rgbd(steps[k][pixel]);
}

Rgbd difference(const LadderImages& images, std::size_t half, std::size_t pixel) {
    return Rgbd(images.first[pixel]) - Rgbd(images.halves[half].back()[pixel]);
}

void add(Causes& sums, const Causes& causes) {
    for (std::size_t i = 0; i < kCauseCount; ++i) sums[i] += causes[i];
}

int largest_step(Rgb a, Rgb b) {
    const SrgbEncoder& encode = srgb_encoder();
    int steps = 0;
    for (std::size_t c = 0; c < 3; ++c) steps = std::max(steps, std::abs(encode(a[c]) - encode(b[c])));
    return steps;
}

Image<Causes> all_causes(const LadderImages& images) {
    Image<Causes> causes(images.first.width(), images.first.height());
    for (std::size_t i = 0; i < causes.size(); ++i) causes[i] = pixel_causes(images, i);
    return causes;
}

/// Returns the cause with the largest sum over a pixel and its neighbors.
std::size_t main_cause_around(const Image<Causes>& causes, std::size_t pixel) {
    const int px = static_cast<int>(pixel) % causes.width(), py = static_cast<int>(pixel) / causes.width();
    Causes sums{};
    for (int y = std::max(py - 1, 0); y <= std::min(py + 1, causes.height() - 1); ++y)
        for (int x = std::max(px - 1, 0); x <= std::min(px + 1, causes.width() - 1); ++x) add(sums, causes(x, y));
    return static_cast<std::size_t>(std::max_element(sums.begin(), sums.end()) - sums.begin());
}

} // namespace

Causes pixel_causes(const LadderImages& images, std::size_t pixel) {
    const Rgbd a = difference(images, 0, pixel), b = difference(images, 1, pixel);
    Causes causes{};
    for (std::size_t k = 0; k < kRungCount; ++k)
        causes[k] = (product(change(images, 0, k, pixel), b) + product(change(images, 1, k, pixel), a)) / 2;
    const Rgbd noise = (a - b) * 0.5;
    causes[kNoise] = product(noise, noise);
    return causes;
}

Shares shares(const LadderImages& images) {
    const int width = images.first.width(), height = images.first.height();
    Causes total{};
    double squares = 0, light = 0; // sums of squares of D and of I₇
    for (int y = 0; y < height; ++y) {
        Causes row{}; // summed per row, because rounding errors grow with the length of a sum
        double row_squares = 0;
        for (int x = 0; x < width; ++x) {
            const auto pixel =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
            add(row, pixel_causes(images, pixel));
            const Rgbd d = (difference(images, 0, pixel) + difference(images, 1, pixel)) * 0.5;
            const Rgbd truth = Rgbd(images.first[pixel]) - d;
            row_squares += product(d, d);
            light += product(truth, truth);
        }
        add(total, row);
        squares += row_squares;
    }
    Shares result;
    result.rms = std::sqrt(squares / (3.0 * width * height));
    result.negligible = !(squares > 1e-10 * light);
    if (result.negligible) return result;
    for (std::size_t i = 0; i < kCauseCount; ++i) result.share[i] = total[i] / squares;
    result.sum = std::accumulate(result.share.begin(), result.share.end(), 0.0);
    return result;
}

CauseMap map_causes(const LadderImages& images) {
    const ImageRgb& first = images.first;
    const ImageRgb last = images.image(kRungCount);
    const Image<Causes> causes = all_causes(images);
    CauseMap map{
        Image<std::uint8_t>(first.width(), first.height()), Image<std::uint8_t>(first.width(), first.height()), {}, 0};
    std::array<std::size_t, kCauseCount> counts{};
    for (std::size_t i = 0; i < first.size(); ++i) {
        map.cause[i] = static_cast<std::uint8_t>(main_cause_around(causes, i));
        map.steps[i] = static_cast<std::uint8_t>(largest_step(first[i], last[i]));
        if (map.steps[i] >= kVisibleSteps) ++counts[map.cause[i]];
    }
    const double visible = static_cast<double>(std::accumulate(counts.begin(), counts.end(), std::size_t{0}));
    map.visible = visible / static_cast<double>(first.size());
    for (std::size_t i = 0; visible > 0 && i < kCauseCount; ++i)
        map.pixels[i] = static_cast<double>(counts[i]) / visible;
    return map;
}

std::array<int, 3> cause_color(std::size_t cause) {
    // The colors are from Okabe and Ito 2008, "Color Universal Design". Noise is gray.
    static constexpr std::array<std::array<int, 3>, kCauseCount> kColors{{{86, 180, 233},
                                                                          {240, 228, 66},
                                                                          {204, 121, 167},
                                                                          {0, 114, 178},
                                                                          {0, 158, 115},
                                                                          {230, 159, 0},
                                                                          {213, 94, 0},
                                                                          {150, 150, 150}}};
    return kColors.at(cause);
}

ImageRgb cause_image(const CauseMap& map) {
    constexpr double kFull = 24; // 8-bit steps from which on a color has full brightness
    ImageRgb image(map.cause.width(), map.cause.height());
    for (std::size_t i = 0; i < image.size(); ++i) {
        const auto color = cause_color(map.cause[i]);
        const double seen = map.steps[i] < kVisibleSteps ? 0.12 : 0.35 + 0.65 * std::min(map.steps[i] / kFull, 1.0);
        for (std::size_t c = 0; c < 3; ++c) image[i][c] = static_cast<float>(srgb_decode(color[c] / 255.0 * seen));
    }
    return image;
}

} // namespace duet::compare
