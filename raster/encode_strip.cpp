#include "raster/encode_strip.h"

#include "common/image/srgb.h"

#include <bit>
#include <cmath>
#include <cstring>

namespace duet::raster {
namespace {

/// How far from a change of code the polynomial's word is taken: three times its error.
constexpr float kDoubt = 0x1p-11f;

/// 255 · 1.055 · 2^(e/2.4), of e from -15 on; of 0 the last.
const StripOf<float> kScales = [] {
    StripOf<float> scales;
    for (std::size_t i = 0; i < kStrip; ++i)
        scales[i] = static_cast<float>(255 * 1.055 * std::pow(2.0, (static_cast<double>(i) - 15) / 2.4));
    return scales;
}();

/// 255 · srgb_encode(x) + ½ to within 1.6e-4, for x in [0, 1]: above the straight part x = m·2^e, m in [1, 2), and x^(5/12)
/// is a polynomial in m (Chebyshev interpolation) times a power of two that a table has.
Floats code_and_half(Floats x) {
    constexpr std::array<float, 7> kPolynomial{0.3518701494f, 1.057500362f, -0.6761592627f, 0.3797715604f, -0.1397501379f, 0.029459171f, -0.002691525733f};
    const Ints bits = xsimd::bitwise_cast<Ints>(x);
    const Floats m = xsimd::bitwise_cast<Floats>((bits & Ints(0x007fffff)) | Ints(0x3f800000));
    Floats power(kPolynomial.back());
    for (std::size_t i = kPolynomial.size() - 1; i-- > 0;) power = fused(power, m, Floats(kPolynomial[i]));
    const Floats curve = fused(power, look_up(kScales, bits >> 23), Floats(static_cast<float>(0.5 - 255 * 0.055)));
    return xsimd::select(x <= Floats(0.0031308f), fused(x, Floats(static_cast<float>(255 * 12.92)), Floats(0.5f)), curve);
}

/// The codes of one channel; `worst` grows to the distance from the middle of a code of what lies farthest from it.
inline Ints encode_channel(const Floats& value, Floats& worst) {
    // Written so that NaN becomes 0.
    const Floats zero(0.0f), x = min(xsimd::select(value > zero, value, zero), Floats(1.0f));
    const Floats code = code_and_half(x), whole = xsimd::floor(code);
    worst = max(worst, abs(code - whole - Floats(0.5f)));
    return xsimd::to_int(whole);
}

// The bytes r, g, b, a in the order of memory.
constexpr bool kLittle = std::endian::native == std::endian::little;
constexpr std::array<int, 4> kShift{kLittle ? 0 : 24, kLittle ? 8 : 16, kLittle ? 16 : 8, kLittle ? 24 : 0};

} // namespace

void encode_strip(const StripColors& colors, std::uint32_t seen, Rgba8 background, StripCodes& codes) {
    const Ints behind(std::bit_cast<std::int32_t>(background));
    for (std::size_t i = 0; i < kStrip; i += Floats::size) {
        Floats worst(0.0f);
        const Ints r = encode_channel(load(colors.r, i), worst), g = encode_channel(load(colors.g, i), worst),
                   b = encode_channel(load(colors.b, i), worst);
        const Ints pixels = (r << kShift[0]) | (g << kShift[1]) | (b << kShift[2]) |
                            Ints(static_cast<std::int32_t>(255u << kShift[3]));
        const std::uint32_t here = seen >> i;
        alignas(64) std::array<std::int32_t, Ints::size> words;
        xsimd::select(xsimd::bool_cast(lanes_from<float>(here)), pixels, behind).store_aligned(words.data());
        std::memcpy(static_cast<void*>(codes.at(i)), words.data(), sizeof(words));
        // Too close to a change of code to be told by the polynomial.
        for (std::uint32_t left = lane_bits(worst > Floats(0.5f - kDoubt)) & here; left != 0; left &= left - 1) {
            const SrgbEncoder& encode = srgb_encoder();
            const std::size_t k = i + static_cast<std::size_t>(std::countr_zero(left));
            codes[k] = {encode(colors.r[k]), encode(colors.g[k]), encode(colors.b[k]), 255};
        }
    }
}

} // namespace duet::raster
