// This file implements the sRGB transfer curve (IEC 61966-2-1), which converts between linear values and the encoded
// values of 8-bit files.
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

/// Encodes a linear value. The curve is increasing and maps [0, 1] to [0, 1]. The result is not clamped: the linear
/// segment extends below 0, and the power segment extends above 1. NaN stays NaN.
template <std::floating_point T> T srgb_encode(T linear) {
    if (linear <= T(0.0031308)) return T(12.92) * linear;
    return T(1.055) * std::pow(linear, T(1) / T(2.4)) - T(0.055);
}

/// Decodes an encoded value to a linear one. This is the inverse of srgb_encode up to rounding; the constants of the
/// standard leave a gap of 3e-8 between the two segments. The result is not clamped. NaN stays NaN.
template <std::floating_point T> T srgb_decode(T encoded) {
    if (encoded <= T(0.04045)) return encoded / T(12.92);
    return std::pow((encoded + T(0.055)) / T(1.055), T(2.4));
}

/// Encodes linear values to 8 bits, rounded to nearest. For every float x in [0, 1], the result is the code k for which
/// 255·srgb_encode(x) lies in [k − ½, k + ½). Negative values and NaN give 0, and values above 1 give 255.
///
/// The encoder compares a value with the 255 thresholds where the code changes, instead of evaluating the curve. Below
/// 2^-13, the code is 0. The floats from there on are divided into intervals of 1/128 of a power of two, so that the
/// upper bits of a float are the index of its interval. Each interval contains at most one threshold. The code at its
/// lower end and one comparison therefore determine the result.
class SrgbEncoder {
public:
    SrgbEncoder();

    std::uint8_t operator()(float linear) const {
        // The comparison is false for NaN, so NaN becomes kSmallest. Values outside the clamped range have the same
        // code as the nearer end of the range.
        const float clamped = linear > kSmallest ? linear : kSmallest;
        const float x = clamped < kOneMinusEpsilon ? clamped : kOneMinusEpsilon;
        const Interval& interval = intervals_[(std::bit_cast<std::uint32_t>(x) - kSmallestBits) >> kShift];
        return static_cast<std::uint8_t>(interval.code + (x >= interval.threshold ? 1u : 0u));
    }

private:
    static constexpr int kShift = 16; ///< drops the lower 16 of the 23 fraction bits
    static constexpr float kSmallest = 0x1p-13f;
    static constexpr std::uint32_t kSmallestBits = std::bit_cast<std::uint32_t>(kSmallest);

    struct Interval {
        std::uint32_t code = 0; ///< code at the lower end of the interval
        float threshold = 0;    ///< smallest float with the next code, inside the interval or above it
    };
    std::array<Interval, (std::size_t{13} << (23 - kShift))> intervals_{};
};

/// Returns the shared encoder, which is constructed on first use. Code with a loop should call srgb_encoder() once
/// before the loop, because each call checks whether the encoder exists.
const SrgbEncoder& srgb_encoder();
/// Encodes one linear value to 8 bits.
inline std::uint8_t srgb_encode_8bit(float linear) { return srgb_encoder()(linear); }
/// Decodes an 8-bit code to a linear value in [0, 1].
inline float srgb_decode_8bit(std::uint8_t code) { return srgb_decode(static_cast<float>(code) / 255.0f); }

/// Encodes an image to 3 bytes per pixel, with rows from the top, on `threads` threads (0: all).
std::vector<std::uint8_t> srgb_encode_8bit(const ImageRgb& image, int threads = 0);

} // namespace duet
