#include "common/image/srgb.h"

#include "common/system/parallel.h"

#include <algorithm>
#include <limits>

namespace duet {

namespace {

// Returns the smallest float that is not below x, for 0 < x < 1.
float round_up(double x) {
    const float nearest = static_cast<float>(x);
    return static_cast<double>(nearest) < x ? std::nextafter(nearest, 2.0f) : nearest;
}

} // namespace

SrgbEncoder::SrgbEncoder() {
    std::array<float, 256> threshold{}; // threshold[k] is the smallest float with code k + 1
    for (std::size_t k = 0; k < 255; ++k) threshold[k] = round_up(srgb_decode((static_cast<double>(k) + 0.5) / 255));
    threshold[255] = std::numeric_limits<float>::infinity();
    std::uint32_t code = 0, bits = kSmallestBits;
    for (Interval& interval : intervals_) {
        while (std::bit_cast<float>(bits) >= threshold[code]) ++code;
        interval = {code, threshold[code]};
        bits += 1u << kShift;
        // The encoder relies on at most one code change in each interval.
        DUET_CHECK(code >= 254 || threshold[code + 1] >= std::bit_cast<float>(bits));
    }
}

const SrgbEncoder& srgb_encoder() {
    static const SrgbEncoder encoder;
    return encoder;
}

std::vector<std::uint8_t> srgb_encode_8bit(const ImageRgb& image, int threads) {
    const SrgbEncoder& encode = srgb_encoder();
    const auto width = static_cast<std::size_t>(image.width());
    std::vector<std::uint8_t> bytes(image.size() * 3);
    // A band has about 64,000 pixels, enough to make the cost of scheduling a task negligible.
    const std::size_t rows = width == 0 ? 1 : 1 + 65536 / width;
    const auto height = static_cast<std::size_t>(image.height());
    parallel_for((height + rows - 1) / rows, threads, [&](std::size_t band) {
        const std::size_t first = band * rows * width, last = std::min((band + 1) * rows, height) * width;
        for (std::size_t i = first; i < last; ++i) {
            const Rgb& pixel = image[i];
            bytes[3 * i] = encode(pixel.r);
            bytes[3 * i + 1] = encode(pixel.g);
            bytes[3 * i + 2] = encode(pixel.b);
        }
    });
    return bytes;
}

} // namespace duet
