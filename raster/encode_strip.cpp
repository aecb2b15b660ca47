#include "raster/encode_strip.h"

#include "common/image/srgb.h"

#include <bit>
#include <cstring>

namespace duet::raster {
namespace {

/// How far from a change of code the polynomial's word is taken: four times its error.
constexpr float kDoubt = 0x1p-11f;

/// 255 · srgb_encode(x) + ½ to within 1.3e-4 + rounding, for x in [0, 1]: above the straight part a polynomial in
/// ⁴√x, whose 5/3rd power the curve is; Chebyshev interpolation between ⁴√0.0031308 and 1.
Floats code_and_half(Floats x) {
    constexpr std::array<float, 8> kPolynomial{-14.438328742980957f, 32.004051208496094f,   369.8117370605469f,
                                               -285.8165588378906f,  292.361328125f,        -212.61557006835938f,
                                               91.53132629394531f,   -17.33802604675293f};
    // Where x is tiny, the straight part is chosen.
    const Floats positive = max(x, Floats(1e-6f)), root = positive * inverse_sqrt(positive), q = root * inverse_sqrt(root);
    Floats curve(kPolynomial.back());
    for (std::size_t i = kPolynomial.size() - 1; i-- > 0;) curve = xsimd::fma(curve, q, Floats(kPolynomial[i]));
    return xsimd::select(x <= Floats(0.0031308f), x * Floats(255 * 12.92f) + Floats(0.5f), curve);
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
    const SrgbEncoder& encode = srgb_encoder();
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
            const std::size_t k = i + static_cast<std::size_t>(std::countr_zero(left));
            codes[k] = {encode(colors.r[k]), encode(colors.g[k]), encode(colors.b[k]), 255};
        }
    }
}

} // namespace duet::raster
