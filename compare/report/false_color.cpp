#include "compare/report/false_color.h"

#include "common/image/srgb.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace duet::compare {

namespace {

// These are nine anchors from dark blue over near white to dark orange, as sRGB bytes. They must match those in the
// page's paint.js.
constexpr std::array<Rgb, 9> kAnchors = {Rgb(8, 48, 107),    Rgb(33, 102, 172),  Rgb(82, 148, 206),
                                         Rgb(167, 205, 230), Rgb(246, 246, 244), Rgb(250, 203, 150),
                                         Rgb(233, 143, 53),  Rgb(190, 92, 8),    Rgb(115, 49, 6)};

double luminance_difference(const ImageRgb& a, const ImageRgb& b, std::size_t i) {
    return luminance(Rgbd(a[i])) - luminance(Rgbd(b[i]));
}

} // namespace

Rgb diverging_color(double value) {
    const double position = (std::clamp(value, -1.0, 1.0) + 1) / 2 * static_cast<double>(kAnchors.size() - 1);
    const std::size_t low = std::min(static_cast<std::size_t>(position), kAnchors.size() - 2);
    return lerp(kAnchors[low], kAnchors[low + 1], static_cast<float>(position - static_cast<double>(low))) / 255.0f;
}

ImageRgb difference_image(const ImageRgb& a, const ImageRgb& b, double range) {
    ImageRgb image(a.width(), a.height());
    for (std::size_t i = 0; i < image.size(); ++i) {
        const double difference = luminance_difference(a, b, i);
        const Rgb color = std::isfinite(difference) ? diverging_color(difference / range) : Rgb(1, 0, 1);
        image[i] = {srgb_decode(color.r), srgb_decode(color.g), srgb_decode(color.b)};
    }
    return image;
}

double difference_range(const ImageRgb& a, const ImageRgb& b) {
    std::vector<double> sizes;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double size = std::abs(luminance_difference(a, b, i));
        if (std::isfinite(size)) sizes.push_back(size);
    }
    if (sizes.empty()) return 0.001;
    const std::size_t rank = (sizes.size() - 1) * 99 / 100;
    std::nth_element(sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(rank), sizes.end());
    const double value = std::max(sizes[rank], 0.001);
    const double power = std::pow(10, std::floor(std::log10(value)));
    for (const double step : {1.0, 2.0, 5.0})
        if (step * power >= value * (1 - 1e-9)) return step * power;
    return 10 * power;
}

} // namespace duet::compare
