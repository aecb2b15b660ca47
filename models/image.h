// This header declares output of PNG textures and Radiance environment maps that is bitwise equal on every platform.
// A library's compressor would change the bytes with its version.
#pragma once

#include "common/image/image.h"

#include <cstdint>
#include <filesystem>

namespace duet::models {

/// An Rgb8 is a pixel with 8 bits per channel, sRGB-encoded.
struct Rgb8 {
    std::uint8_t r = 0, g = 0, b = 0;
    friend bool operator==(const Rgb8&, const Rgb8&) = default;
};

/// Writes an 8-bit RGB PNG file (ISO/IEC 15948). Its rows have the filter "Up" and are compressed by DEFLATE's fixed
/// codes (RFC 1951, §3.2.6), with matches found by hashing.
void write_png(const std::filesystem::path& path, const Image<Rgb8>& image);

/// Writes a Radiance image (Ward 1991, "Real Pixels", Graphics Gems II): linear RGB with a shared exponent. The width
/// must be 8 to 32767.
void write_hdr(const std::filesystem::path& path, const ImageRgb& image);

} // namespace duet::models
