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

/// One channel; true where some value is too close to a change of code to be told by the polynomial.
bool encode_channel(const StripOf<float>& linear, StripOf<std::int32_t>& codes, StripOf<std::int32_t>& doubtful) {
    bool any = false;
    for (std::size_t i = 0; i < kStrip; i += Floats::size) {
        const Floats value = load(linear, i), zero(0.0f);
        // Written so that NaN becomes 0.
        const Floats x = min(xsimd::select(value > zero, value, zero), Floats(1.0f));
        const Floats code = code_and_half(x), whole = xsimd::floor(code), rest = code - whole;
        const auto doubt = rest < Floats(kDoubt) || rest > Floats(1 - kDoubt);
        store(codes, i, xsimd::to_int(whole));
        if (!xsimd::any(doubt)) continue;
        any = true;
        store(doubtful, i, xsimd::select(xsimd::bool_cast(doubt), Ints(1), Ints(0)));
    }
    return any;
}

void encode_exactly(const StripOf<float>& linear, const StripOf<std::int32_t>& doubtful, StripOf<std::int32_t>& codes) {
    const SrgbEncoder& encode = srgb_encoder();
    for (std::size_t i = 0; i < kStrip; ++i)
        if (doubtful[i] != 0) codes[i] = encode(linear[i]);
}

} // namespace

void encode_strip(const StripColors& colors, std::array<Rgba8, kStrip>& codes) {
    std::array<StripOf<std::int32_t>, 3> channels;
    const std::array<const StripOf<float>*, 3> linear{&colors.r, &colors.g, &colors.b};
    for (std::size_t c = 0; c < 3; ++c) {
        StripOf<std::int32_t> doubtful;
        if (encode_channel(*linear[c], channels[c], doubtful)) encode_exactly(*linear[c], doubtful, channels[c]);
    }
    // The bytes r, g, b, 255 in the order of memory.
    constexpr bool kLittle = std::endian::native == std::endian::little;
    constexpr std::array<int, 4> kShift{kLittle ? 0 : 24, kLittle ? 8 : 16, kLittle ? 16 : 8, kLittle ? 24 : 0};
    StripOf<std::int32_t> pixels;
    for (std::size_t i = 0; i < kStrip; i += Ints::size)
        store(pixels, i, (load(channels[0], i) << kShift[0]) | (load(channels[1], i) << kShift[1]) |
                             (load(channels[2], i) << kShift[2]) | Ints(static_cast<std::int32_t>(255u << kShift[3])));
    std::memcpy(static_cast<void*>(codes.data()), pixels.at(0), sizeof(codes));
}

} // namespace duet::raster
