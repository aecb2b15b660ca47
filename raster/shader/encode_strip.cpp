#include "raster/shader/encode_strip.h"

#include "common/image/srgb.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace duet::raster {
namespace {

/// The polynomial's result is not trusted within this distance of a rounding boundary, in codes. It is three times
/// the polynomial's error.
constexpr double kDoubt = 0x1p-11;

/// Fixed-point codes are in units of 2^-16 and biased by half a code plus kDoubt. The 8-bit code is thus the value
/// without its lower sixteen bits, and it is in doubt if those are less than twice kDoubt.
constexpr double kCode = 1 << 16, kMoved = (0.5 + kDoubt) * kCode;
constexpr std::int32_t kNoDoubt = 0xffff & ~static_cast<std::int32_t>(2 * kDoubt * kCode - 1);

/// The table holds 255 · 1.055 · 2^(e/2.4) as fixed-point codes. Entry i is for e = i − 15.
const StripOf<float> kScales = [] {
    StripOf<float> scales;
    for (std::size_t i = 0; i < kStrip; ++i)
        scales[i] = static_cast<float>(kCode * 255 * 1.055 * std::pow(2.0, (static_cast<double>(i) - 15) / 2.4));
    return scales;
}();

/// The sRGB transfer function is linear up to this value.
constexpr float kStraight = 0.0031308f;

/// Returns the biased fixed-point code of x, to within 1.6e-4 of a code, for x in (kStraight, 1]. With x = m·2^e
/// and m in [1, 2), x^(5/12) is a polynomial in m (Chebyshev interpolation) times a power of two from a table.
Floats curved_code(const Floats& x) {
    constexpr std::array<float, 7> kPolynomial{0.3518701494f,  1.057500362f, -0.6761592627f,  0.3797715604f,
                                               -0.1397501379f, 0.029459171f, -0.002691525733f};
    const Ints bits = xsimd::bitwise_cast<Ints>(x);
    const Floats m = xsimd::bitwise_cast<Floats>((bits & Ints(0x007fffff)) | Ints(0x3f800000));
    Floats power(kPolynomial.back());
    for (std::size_t i = kPolynomial.size() - 1; i-- > 0;) power = fused(power, m, Floats(kPolynomial[i]));
    return fused(power, look_up(kScales, bits >> 23), Floats(static_cast<float>(kMoved - kCode * 255 * 0.055)));
}
/// Returns the biased fixed-point code of any number.
Floats moved_code(const Floats& value) {
    // The order of operands turns NaN into 0.
    const Floats zero(0.0f), x = min(xsimd::select(value > zero, value, zero), Floats(1.0f));
    const Floats straight =
        fused(x, Floats(static_cast<float>(kCode * 255 * 12.92)), Floats(static_cast<float>(kMoved)));
    return xsimd::select(x <= Floats(kStraight), straight, curved_code(x));
}

/// Returns one bit per lane with a channel outside the range of curved_code(), which is rare.
std::uint32_t not_curved(const RgbT<Floats>& c) {
    // Compared as integers, NaN is too large, and negative values are too small.
    const auto bits = [](const Floats& x) { return xsimd::bitwise_cast<Ints>(x); };
    const Ints least = min(min(bits(c.r), bits(c.g)), bits(c.b)), most = max(max(bits(c.r), bits(c.g)), bits(c.b));
    return lane_bits(least <= bits(Floats(kStraight))) | lane_bits(most > bits(Floats(1.0f)));
}

// Moves a code from its fixed-point position to a channel's byte in memory (order r, g, b, a).
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

/// Packs biased fixed-point codes into pixels. `doubtful` gets one bit per pixel that the polynomial can't decide.
Ints packed(const RgbT<Floats>& moved, std::uint32_t& doubtful) {
    const Ints r = xsimd::to_int(moved.r), g = xsimd::to_int(moved.g), b = xsimd::to_int(moved.b);
    const auto in_doubt = [](const Ints& code) { return lane_bits((code & Ints(kNoDoubt)) == Ints(0)); };
    doubtful = in_doubt(r) | in_doubt(g) | in_doubt(b);
    return in_place<0>(r) | in_place<1>(g) | in_place<2>(b) | Ints(kOpaque);
}

RgbT<Floats> batch(const StripColors& colors, std::size_t i) {
    return {load(colors.r, i), load(colors.g, i), load(colors.b, i)};
}

/// Stores the pixels of one batch of samples from the i-th on. Samples whose bit in `seen` is 0 get `behind`.
void put(const Ints& pixels, const Ints& behind, std::uint32_t seen, std::size_t i, StripCodes& codes) {
    alignas(64) std::array<std::int32_t, Ints::size> words;
    xsimd::select(xsimd::bool_cast(lanes_from<float>(seen >> i)), pixels, behind).store_aligned(words.data());
    std::memcpy(static_cast<void*>(codes.at(i)), words.data(), sizeof(words));
}

/// Holds the samples that encode() leaves undecided, one bit each: those in doubt, and those outside the range of
/// curved_code().
struct Left {
    std::uint32_t doubtful, other;
};

/// Encodes a packet as if all values were in the range of curved_code().
Left encode(const StripColors& colors, std::uint32_t seen, const Ints& behind, StripCodes& codes) {
    Left left{0, 0};
    for (std::size_t i = 0; i < kStrip; i += Floats::size) {
        const RgbT<Floats> c = batch(colors, i);
        std::uint32_t doubtful = 0;
        put(packed({curved_code(c.r), curved_code(c.g), curved_code(c.b)}, doubtful), behind, seen, i, codes);
        left.doubtful |= doubtful << i;
        left.other |= not_curved(c) << i;
    }
    return {left.doubtful & seen, left.other & seen};
}

/// Encodes a packet of any values. Returns one bit per sample in doubt.
std::uint32_t encode_any(const StripColors& colors, std::uint32_t seen, const Ints& behind, StripCodes& codes) {
    std::uint32_t all_doubtful = 0;
    for (std::size_t i = 0; i < kStrip; i += Floats::size) {
        const RgbT<Floats> c = batch(colors, i);
        std::uint32_t doubtful = 0;
        put(packed({moved_code(c.r), moved_code(c.g), moved_code(c.b)}, doubtful), behind, seen, i, codes);
        all_doubtful |= doubtful << i;
    }
    return all_doubtful & seen;
}

void encode_one_by_one(const StripColors& colors, std::uint32_t samples, StripCodes& codes) {
    const SrgbEncoder& encode = srgb_encoder();
    for (; samples != 0; samples &= samples - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(samples));
        codes[i] = {encode(colors.r[i]), encode(colors.g[i]), encode(colors.b[i]), 255};
    }
}

} // namespace

void encode_strips(std::span<const StripColors> colors, const std::uint32_t* seen, Rgba8 background,
                   StripCodes* const* codes) {
    const Ints behind(std::bit_cast<std::int32_t>(background));
    constexpr std::size_t kTogether = 64; // few enough to keep the polynomial's coefficients in registers
    std::array<Left, kTogether> left;
    for (std::size_t first = 0; first < colors.size(); first += kTogether) {
        const std::size_t count = std::min(kTogether, colors.size() - first);
        for (std::size_t s = 0; s < count; ++s)
            left[s] = encode(colors[first + s], seen[first + s], behind, *codes[first + s]);
        for (std::size_t s = 0; s < count; ++s) {
            if ((left[s].doubtful | left[s].other) == 0) continue;
            const StripColors& of = colors[first + s];
            StripCodes& to = *codes[first + s];
            encode_one_by_one(of, left[s].other == 0 ? left[s].doubtful : encode_any(of, seen[first + s], behind, to),
                              to);
        }
    }
}

} // namespace duet::raster
