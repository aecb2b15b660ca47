#include "compare/view/image_comparison.h"

#include "compare/metrics/flip.h"
#include "compare/report/false_color.h"

#include <cmath>

namespace duet::compare {

ImageComparison signed_comparison(const ImageRgb& a, const ImageRgb& b, int threads) {
    const double range = difference_range(a, b);
    return {display_bytes(difference_image(a, b, range), {}, threads), range};
}

ImageComparison flip_comparison(const ImageRgb& a, const ImageRgb& b, const ViewTransform& transform, int threads) {
    const auto shown = [&](const ImageRgb& image) {
        const std::vector<std::uint8_t> bytes = display_bytes(image, transform, threads);
        ImageRgb encoded(image.width(), image.height());
        for (std::size_t i = 0; i < encoded.size(); ++i)
            encoded[i] = Rgb(bytes[3 * i], bytes[3 * i + 1], bytes[3 * i + 2]) / 255.0f;
        return encoded;
    };
    const Flip result = flip(shown(a), shown(b), kFlipPixelsPerDegree, threads);
    ImageComparison comparison{.figure = result.mean};
    for (const float error : result.map) {
        const Rgb color = diverging_color(static_cast<double>(error)) * 255.0f;
        for (const float channel : {color.r, color.g, color.b})
            comparison.bytes.push_back(static_cast<std::uint8_t>(std::lround(channel)));
    }
    return comparison;
}

} // namespace duet::compare
