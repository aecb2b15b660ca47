#include "raster/shader/srgb_packet.h"

#include "common/image/srgb.h"
#include "raster/geometry/packet_lookup.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace duet::raster {
namespace {

/// The polynomial's result is not trusted within this distance of a rounding boundary, in codes. It is three times
/// the polynomial's error.
constexpr double kUncertainty = 0x1p-11;

/// Fixed-point codes are in units of 2^-16 and biased by half a code plus kUncertainty. Without its lower sixteen bits,
/// a fixed-point code is the 8-bit code. It is in doubt if the lower bits are less than twice kUncertainty.
constexpr double kCode = 1 << 16, kBias = (0.5 + kUncertainty) * kCode;
constexpr std::int32_t kCertain = 0xffff & ~static_cast<std::int32_t>(2 * kUncertainty * kCode - 1);

/// The table holds 255 · 1.055 · 2^(e/2.4) as fixed-point codes. Entry i is for e = i − 15.
const PacketOf<float> kScales = [] {
    PacketOf<float> scales;
    for (std::size_t i = 0; i < kPacketSize; ++i)
        scales[i] = static_cast<float>(kCode * 255 * 1.055 * std::pow(2.0, (static_cast<double>(i) - 15) / 2.4));
    return scales;
}();

/// The sRGB transfer function is linear up to this value.
constexpr float kLinearLimit = 0.0031308f;

/// Returns the biased fixed-point code of x, to within 1.6e-4 of a code, for x in (kLinearLimit, 1]. With x = m·2^e
/// and m in [1, 2), x^(5/12) is a polynomial in m (Chebyshev interpolation) times a power of two from a table.
Floats gamma_code(const Floats& x) {
    constexpr std::array<float, 7> kPolynomial{0.3518701494f,  1.057500362f, -0.6761592627f,  0.3797715604f,
                                               -0.1397501379f, 0.029459171f, -0.002691525733f};
    const Ints bits = xsimd::bitwise_cast<Ints>(x);
    const Floats m = xsimd::bitwise_cast<Floats>((bits & Ints(0x007fffff)) | Ints(0x3f800000));
    Floats power(kPolynomial.back());
    for (std::size_t i = kPolynomial.size() - 1; i-- > 0;) power = multiply_add(power, m, Floats(kPolynomial[i]));
    return multiply_add(power, look_up(kScales, bits >> 23), Floats(static_cast<float>(kBias - kCode * 255 * 0.055)));
}
/// Returns the biased fixed-point code of any number.
Floats biased_code(const Floats& value) {
    // The order of operands turns NaN into 0.
    const Floats zero(0.0f), x = min(xsimd::select(value > zero, value, zero), Floats(1.0f));
    const Floats linear =
        multiply_add(x, Floats(static_cast<float>(kCode * 255 * 12.92)), Floats(static_cast<float>(kBias)));
    return xsimd::select(x <= Floats(kLinearLimit), linear, gamma_code(x));
}

/// Returns one bit per lane with a channel outside the range of gamma_code(), which is rare.
std::uint32_t outside_gamma_range(const RgbT<Floats>& c) {
    // Compared as integers, NaN is too large and negative values are too small.
    const auto bits = [](const Floats& x) { return xsimd::bitwise_cast<Ints>(x); };
    const Ints least = min(min(bits(c.r), bits(c.g)), bits(c.b)), most = max(max(bits(c.r), bits(c.g)), bits(c.b));
    return lane_bits(least <= bits(Floats(kLinearLimit))) | lane_bits(most > bits(Floats(1.0f)));
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

/// Packs biased fixed-point codes into pixels. `uncertain` gets one bit per pixel that the polynomial can't decide.
Ints packed(const RgbT<Floats>& biased, std::uint32_t& uncertain) {
    const Ints r = xsimd::to_int(biased.r), g = xsimd::to_int(biased.g), b = xsimd::to_int(biased.b);
    const auto is_uncertain = [](const Ints& code) { return lane_bits((code & Ints(kCertain)) == Ints(0)); };
    uncertain = is_uncertain(r) | is_uncertain(g) | is_uncertain(b);
    return in_place<0>(r) | in_place<1>(g) | in_place<2>(b) | Ints(kOpaque);
}

RgbT<Floats> batch(const ColorPacket& colors, std::size_t i) {
    return {load(colors.r, i), load(colors.g, i), load(colors.b, i)};
}

/// Stores the pixels of one batch of samples from the i-th on. Samples whose bit in `visible` is 0 get `behind`.
void put(const Ints& pixels, const Ints& behind, std::uint32_t visible, std::size_t i, SrgbPacket& codes) {
    alignas(64) std::array<std::int32_t, Ints::size> words;
    xsimd::select(xsimd::bool_cast(lanes_from<float>(visible >> i)), pixels, behind).store_aligned(words.data());
    std::memcpy(static_cast<void*>(codes.at(i)), words.data(), sizeof(words));
}

/// Holds the samples that encode() leaves undecided, one bit each: those in doubt, and those outside the range of
/// gamma_code().
struct Undecided {
    std::uint32_t uncertain, other;
};

/// Encodes a packet as if all values were in the range of gamma_code().
Undecided encode(const ColorPacket& colors, std::uint32_t visible, const Ints& behind, SrgbPacket& codes) {
    Undecided left{0, 0};
    for (std::size_t i = 0; i < kPacketSize; i += Floats::size) {
        const RgbT<Floats> c = batch(colors, i);
        std::uint32_t uncertain = 0;
        put(packed({gamma_code(c.r), gamma_code(c.g), gamma_code(c.b)}, uncertain), behind, visible, i, codes);
        left.uncertain |= uncertain << i;
        left.other |= outside_gamma_range(c) << i;
    }
    return {left.uncertain & visible, left.other & visible};
}

/// Encodes a packet of any values. Returns one bit per sample in doubt.
std::uint32_t encode_any(const ColorPacket& colors, std::uint32_t visible, const Ints& behind, SrgbPacket& codes) {
    std::uint32_t all_uncertain = 0;
    for (std::size_t i = 0; i < kPacketSize; i += Floats::size) {
        const RgbT<Floats> c = batch(colors, i);
        std::uint32_t uncertain = 0;
        put(packed({biased_code(c.r), biased_code(c.g), biased_code(c.b)}, uncertain), behind, visible, i, codes);
        all_uncertain |= uncertain << i;
    }
    return all_uncertain & visible;
}

void encode_one_by_one(const ColorPacket& colors, std::uint32_t samples, SrgbPacket& codes) {
    const SrgbEncoder& encode = srgb_encoder();
    for (const std::size_t i : SetBits(samples))
        codes[i] = {encode(colors.r[i]), encode(colors.g[i]), encode(colors.b[i]), 255};
}

} // namespace

void encode_packets(std::span<const ColorPacket> colors, const std::uint32_t* visible, Rgba8 background,
                    SrgbPacket* const* codes) {
    const Ints behind(std::bit_cast<std::int32_t>(background));
    constexpr std::size_t kChunk = 64; // few enough to keep the polynomial's coefficients in registers
    std::array<Undecided, kChunk> left;
    for (std::size_t first = 0; first < colors.size(); first += kChunk) {
        const std::size_t count = std::min(kChunk, colors.size() - first);
        for (std::size_t s = 0; s < count; ++s)
            left[s] = encode(colors[first + s], visible[first + s], behind, *codes[first + s]);
        for (std::size_t s = 0; s < count; ++s) {
            if ((left[s].uncertain | left[s].other) == 0) continue;
            const ColorPacket& of = colors[first + s];
            SrgbPacket& to = *codes[first + s];
            encode_one_by_one(
                of, left[s].other == 0 ? left[s].uncertain : encode_any(of, visible[first + s], behind, to), to);
        }
    }
}

} // namespace duet::raster
