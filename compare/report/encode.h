// This file compresses images without loss to text for a web page.
#pragma once

#include "common/image/image.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace duet::compare {

/// Returns the bits of the IEEE half-precision number nearest to a float (ties to even). Values beyond ±65504
/// become the largest finite number; infinities and NaN are preserved.
std::uint16_t half_bits(float value);

/// Returns the bytes in Base64 with padding (RFC 4648, §4).
std::string base64(std::string_view bytes);

/// Encodes an image of unsigned integers of `bytes` bytes each (1 to 4) as Base64 text. Each value is replaced
/// by its difference from its left neighbor (modulo 2^(8·bytes); from 0 at the start of a row). The differences
/// are stored as planes of equal significance, highest byte first, and deflated (zlib format). This resembles
/// PNG's filters, but works for integers of any width.
std::string encode_plane(const std::vector<std::uint32_t>& values, int width, int bytes);

/// Encodes an image's red, green and blue in half precision, two bytes each, by encode_plane.
std::vector<std::string> encode_image(const ImageRgb& image);

} // namespace duet::compare
