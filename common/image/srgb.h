// The sRGB transfer curve (IEC 61966-2-1): between linear light and the values of 8-bit files.
#pragma once

#include "common/image/image.h"

#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace duet {

/// The encoded value of a linear one: [0, 1] to [0, 1], increasing. Not clamped: below 0 the straight part goes on,
/// above 1 the power does. NaN stays NaN.
template <std::floating_point T> T srgb_encode(T linear) {
    if (linear <= T(0.0031308)) return T(12.92) * linear;
    return T(1.055) * std::pow(linear, T(1) / T(2.4)) - T(0.055);
}

/// The linear value of an encoded one, inverse to srgb_encode up to rounding (the standard's constants leave a gap of
/// 3e-8 where the parts meet). Not clamped. NaN stays NaN.
template <std::floating_point T> T srgb_decode(T encoded) {
    if (encoded <= T(0.04045)) return encoded / T(12.92);
    return std::pow((encoded + T(0.055)) / T(1.055), T(2.4));
}

/// Linear values to 8 bits, rounded to nearest: the k for which 255·srgb_encode(x) lies in [k − ½, k + ½), for every
/// float x; below 0 and NaN: 0, above 1: 255.
///
/// The curve is not evaluated: a value's code follows from comparing it with the 255 values where the code changes.
/// Floats above 2^-13 (below, the code is 0) are cut into intervals of 1/128 of a power of two, which are the upper
/// bits of the float itself; each holds at most one such change, so the interval's first code and one comparison
/// suffice.
class SrgbEncoder {
public:
    SrgbEncoder();

    std::uint8_t operator()(float linear) const {
        // Written so that NaN becomes the smallest; both ends have the code of all that lies beyond.
        const float clamped = linear > kSmallest ? linear : kSmallest;
        const float x = clamped < kOneMinusEpsilon ? clamped : kOneMinusEpsilon;
        const Interval& interval = intervals_[(std::bit_cast<std::uint32_t>(x) - kSmallestBits) >> kShift];
        return static_cast<std::uint8_t>(interval.code + (x >= interval.change ? 1u : 0u));
    }

private:
    static constexpr int kShift = 16; ///< 23 bits of fraction, of which 7 are kept
    static constexpr float kSmallest = 0x1p-13f;
    static constexpr std::uint32_t kSmallestBits = std::bit_cast<std::uint32_t>(kSmallest);

    struct Interval {
        std::uint32_t code = 0; ///< of its lower end
        float change = 0;       ///< the smallest float of the next code, within the interval or above
    };
    std::array<Interval, (std::size_t{13} << (23 - kShift))> intervals_{};
};

/// One value, by a table made on first use. Loops take `srgb_encoder()` once, outside.
const SrgbEncoder& srgb_encoder();
inline std::uint8_t srgb_encode_8bit(float linear) { return srgb_encoder()(linear); }
/// The linear value of an 8-bit code.
inline float srgb_decode_8bit(std::uint8_t code) { return srgb_decode(static_cast<float>(code) / 255.0f); }

/// A whole picture: 3 bytes a pixel, rows from the top, on `threads` threads (0: all).
std::vector<std::uint8_t> srgb_encode_8bit(const ImageRgb& image, int threads = 0);

} // namespace duet
