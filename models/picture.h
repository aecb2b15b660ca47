// Pictures that models are made of: PNG textures and Radiance environments, the same bytes on every machine (a
// library's compressor would change them with its version).
#pragma once

#include "common/image/image.h"

#include <cstdint>
#include <filesystem>

namespace duet::models {

/// 8 bits a channel, sRGB-encoded.
struct Rgb8 {
    std::uint8_t r = 0, g = 0, b = 0;
    friend bool operator==(const Rgb8&, const Rgb8&) = default;
};

/// Writes an 8-bit RGB PNG file (ISO/IEC 15948), its rows filtered by «Up», compressed by DEFLATE's fixed codes (RFC
/// 1951, §3.2.6) with repeats found by hashing.
void write_png(const std::filesystem::path& path, const Image<Rgb8>& image);

/// Writes a Radiance picture (Ward 1991, «Real Pixels», Graphics Gems II): linear RGB with a shared exponent. Width 8
/// to 32767.
void write_hdr(const std::filesystem::path& path, const ImageRgb& image);

} // namespace duet::models
