// Pictures as text for a web page: small, and the same after decoding.
#pragma once

#include "common/image/image.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace duet::compare {

/// The IEEE half-precision number nearest to a float (ties to even), as bits. Beyond ±65504: the largest finite one;
/// infinities and NaN stay themselves.
std::uint16_t half_bits(float value);

/// Base64 with padding (RFC 4648, §4).
std::string base64(std::string_view bytes);

/// A picture of unsigned numbers of `bytes` (1 to 4) bytes each as base64 text. Each number becomes its difference from
/// its left neighbour (modulo 2^(8·bytes); the first of a row: from 0), the differences are stored as planes of equal
/// significance, the highest byte first, and deflated (zlib format): like PNG's filters, but for numbers of any width.
std::string encode_plane(const std::vector<std::uint32_t>& values, int width, int bytes);

/// A picture's red, green and blue in half precision, two bytes a number, each as encode_plane makes it.
std::vector<std::string> encode_picture(const ImageRgb& image);

} // namespace duet::compare
