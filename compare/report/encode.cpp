#include "compare/report/encode.h"

#include <bit>
#include <cmath>
#include <zlib.h>

namespace duet::compare {

std::uint16_t half_bits(float value) {
    const auto sign = static_cast<std::uint16_t>(std::signbit(value) ? 0x8000 : 0);
    const auto with_sign = [&](std::uint32_t bits) { return static_cast<std::uint16_t>(sign | bits); };
    const float size = std::abs(value);
    if (std::isnan(value)) return with_sign(0x7e00);
    if (std::isinf(value)) return with_sign(0x7c00);
    if (size >= 65504.0f) return with_sign(0x7bff);
    // Below 2^-14 the step is 2^-24. nearbyint rounds ties to even. A result of 1024 steps yields the bits of 2^-14.
    if (size < 0x1p-14f) return with_sign(static_cast<std::uint32_t>(std::nearbyint(size * 0x1p24f)));
    // Drop 13 of 23 mantissa bits, rounding ties to even. A carry into the exponent gives the correct result.
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(size);
    const std::uint32_t rounded = bits + 0xfff + ((bits >> 13) & 1);
    return with_sign((rounded >> 13) - (112u << 10)); // the exponent bias is 127 in float, 15 in half
}

std::string base64(std::string_view bytes) {
    static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const auto byte = [&](std::size_t i) {
        return i < bytes.size() ? static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i])) : 0u;
    };
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::uint32_t group = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
        text += kDigits[group >> 18];
        text += kDigits[group >> 12 & 63];
        text += i + 1 < bytes.size() ? kDigits[group >> 6 & 63] : '=';
        text += i + 2 < bytes.size() ? kDigits[group & 63] : '=';
    }
    return text;
}

namespace {

std::string deflate(const std::string& bytes) {
    uLongf size = compressBound(static_cast<uLong>(bytes.size()));
    std::string packed(size, '\0');
    const int status = compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                                 reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()), 6);
    if (status != Z_OK) throw Error(message("the report's images cannot be compressed: zlib error ", status), 1);
    packed.resize(size);
    return packed;
}

} // namespace

std::string encode_plane(const std::vector<std::uint32_t>& values, int width, int bytes) {
    std::string planes(values.size() * static_cast<std::size_t>(bytes), '\0');
    const auto columns = static_cast<std::size_t>(width);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::uint32_t difference = values[i] - (i % columns == 0 ? 0 : values[i - 1]);
        for (int b = 0; b < bytes; ++b)
            planes[static_cast<std::size_t>(b) * values.size() + i] =
                static_cast<char>(difference >> (8 * (bytes - 1 - b)) & 255);
    }
    return base64(deflate(planes));
}

std::vector<std::string> encode_image(const ImageRgb& image) {
    std::vector<std::string> planes;
    std::vector<std::uint32_t> values(image.size());
    for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = half_bits(image[i][c]);
        planes.push_back(encode_plane(values, image.width(), 2));
    }
    return planes;
}

} // namespace duet::compare
