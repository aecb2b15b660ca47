#include "raster/shader/encode_strip.h"

#include "common/image/srgb.h"

#include <bit>
#include <cmath>
#include <cstring>

namespace duet::raster {
namespace {

/// How far from a change of code the polynomial's word is taken: three times its error.
constexpr double kDoubt = 0x1p-11;

/// Codes are counted in units of 2^-16, and moved up by half a code and kDoubt: so the code is what a number is but for its lower
/// sixteen bits, and doubtful where those are less than twice kDoubt.
constexpr double kCode = 1 << 16, kMoved = (0.5 + kDoubt) * kCode;
constexpr std::int32_t kNoDoubt = 0xffff & ~static_cast<std::int32_t>(2 * kDoubt * kCode - 1);

/// 255 · 1.055 · 2^(e/2.4) codes, of e from -15 on; of 0 the last.
const StripOf<float> kScales = [] {
    StripOf<float> scales;
    for (std::size_t i = 0; i < kStrip; ++i)
        scales[i] = static_cast<float>(kCode * 255 * 1.055 * std::pow(2.0, (static_cast<double>(i) - 15) / 2.4));
    return scales;
}();

/// sRGB is a straight line up to here.
constexpr float kStraight = 0.0031308f;

/// The moved code of x, to within 1.6e-4 of a code, for x in (kStraight, 1]: x = m·2^e, m in [1, 2), and x^(5/12) is a polynomial in m
/// (Chebyshev interpolation) times a power of two that a table has.
Floats curved_code(const Floats& x) {
    constexpr std::array<float, 7> kPolynomial{0.3518701494f,  1.057500362f, -0.6761592627f,  0.3797715604f,
                                               -0.1397501379f, 0.029459171f, -0.002691525733f};
    const Ints bits = xsimd::bitwise_cast<Ints>(x);
    const Floats m = xsimd::bitwise_cast<Floats>((bits & Ints(0x007fffff)) | Ints(0x3f800000));
    Floats power(kPolynomial.back());
    for (std::size_t i = kPolynomial.size() - 1; i-- > 0;) power = fused(power, m, Floats(kPolynomial[i]));
    return fused(power, look_up(kScales, bits >> 23), Floats(static_cast<float>(kMoved - kCode * 255 * 0.055)));
}
/// The same of any number.
Floats moved_code(const Floats& value) {
    // Written so that NaN becomes 0.
    const Floats zero(0.0f), x = min(xsimd::select(value > zero, value, zero), Floats(1.0f));
    const Floats straight = fused(x, Floats(static_cast<float>(kCode * 255 * 12.92)), Floats(static_cast<float>(kMoved)));
    return xsimd::select(x <= Floats(kStraight), straight, curved_code(x));
}

/// Whether the curve is all that is asked for of those lanes whose bits are given, as it mostly is.
bool all_curved(const RgbT<Floats>& c, std::uint32_t lanes) {
    // As whole numbers: so NaN is too large, and what is negative too small.
    const auto bits = [](const Floats& x) { return xsimd::bitwise_cast<Ints>(x); };
    const Ints least = min(min(bits(c.r), bits(c.g)), bits(c.b)), most = max(max(bits(c.r), bits(c.g)), bits(c.b));
    return (lanes & ~(lane_bits(least > bits(Floats(kStraight))) & lane_bits(most <= bits(Floats(1.0f))))) == 0;
}

// A moved code to the place that a channel has in memory: the bytes r, g, b, a.
constexpr bool kLittle = std::endian::native == std::endian::little;
template <int kChannel> Ints in_place(const Ints& code) {
    constexpr int kShift = 8 * (kLittle ? kChannel : 3 - kChannel);
    constexpr auto kMask = static_cast<std::int32_t>(0xffu << kShift);
    if constexpr (kShift <= 16)
        return (code >> (16 - kShift)) & Ints(kMask);
    else
        return (code << (kShift - 16)) & Ints(kMask);
}
constexpr auto kOpaque = static_cast<std::int32_t>(0xffu << (kLittle ? 24 : 0));

/// Pixels of moved codes; a bit in `doubtful` for each that the polynomial can't tell.
Ints packed(const RgbT<Floats>& moved, std::uint32_t& doubtful) {
    const Ints r = xsimd::to_int(moved.r), g = xsimd::to_int(moved.g), b = xsimd::to_int(moved.b);
    const auto in_doubt = [](const Ints& code) { return lane_bits((code & Ints(kNoDoubt)) == Ints(0)); };
    doubtful = in_doubt(r) | in_doubt(g) | in_doubt(b);
    return in_place<0>(r) | in_place<1>(g) | in_place<2>(b) | Ints(kOpaque);
}

} // namespace

void encode_strip(const StripColors& colors, std::uint32_t seen, Rgba8 background, StripCodes& codes) {
    const Ints behind(std::bit_cast<std::int32_t>(background));
    constexpr std::uint32_t kAllLanes = (1u << Floats::size) - 1;
    for (std::size_t i = 0; i < kStrip; i += Floats::size) {
        const std::uint32_t here = seen >> i & kAllLanes;
        const RgbT<Floats> c(load(colors.r, i), load(colors.g, i), load(colors.b, i));
        std::uint32_t doubtful = 0;
        const Ints pixels = all_curved(c, here) ? packed({curved_code(c.r), curved_code(c.g), curved_code(c.b)}, doubtful)
                                                : packed({moved_code(c.r), moved_code(c.g), moved_code(c.b)}, doubtful);
        alignas(64) std::array<std::int32_t, Ints::size> words;
        xsimd::select(xsimd::bool_cast(lanes_from<float>(here)), pixels, behind).store_aligned(words.data());
        std::memcpy(static_cast<void*>(codes.at(i)), words.data(), sizeof(words));
        for (std::uint32_t left = doubtful & here; left != 0; left &= left - 1) {
            const SrgbEncoder& encode = srgb_encoder();
            const std::size_t k = i + static_cast<std::size_t>(std::countr_zero(left));
            codes[k] = {encode(colors.r[k]), encode(colors.g[k]), encode(colors.b[k]), 255};
        }
    }
}

} // namespace duet::raster
