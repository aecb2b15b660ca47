// These functions read and write image files: PNG, JPEG, TGA, PPM (P3, P6), PFM, HDR (Radiance) and EXR.
#pragma once

#include "common/image/image.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace duet {

/// Holds the values of an image file as stored. Each pixel has `channels` (1 to 4) interleaved floats; rows are stored
/// from the top.
struct StoredImage {
    /// `kEncoded` values are sRGB-encoded: 8 or 16 bits, scaled to [0, 1] (PNG, JPEG, TGA, PPM). Their second of two
    /// channels or fourth of four is linear alpha. `kLinear` values are linear radiance of any size (PFM, HDR, EXR).
    enum class Encoding { kEncoded, kLinear };

    int width = 0, height = 0, channels = 0;
    Encoding encoding = Encoding::kLinear;
    std::vector<float> values;
};

/// These limits apply to the width, the height and the number of pixels (about 1 GiB as RGB floats) of image files. A
/// file whose header claims more is rejected before any memory is allocated.
inline constexpr int kMaxImageSide = 32768;
inline constexpr long long kMaxImagePixels = 90'000'000;

/// Reads an image file. Its signature determines the format, not the file extension; TGA has no signature and is chosen
/// by its extension. Of an EXR file, the channels R, G, B (or Y) and A are read inside the data window, wherever that
/// lies. Throws an Error that names the path, what was found and what was expected if the file is missing, truncated,
/// malformed or over the limits.
StoredImage read_stored_image(const std::filesystem::path& path);

/// Converts the values of a file to linear RGB. Encoded values are decoded by the sRGB curve, gray is copied to all
/// three channels, and alpha is dropped.
ImageRgb to_linear(const StoredImage& file);
/// Returns to_linear(read_stored_image(path)).
ImageRgb read_image(const std::filesystem::path& path);

struct WriteOptions {
    bool ascii_ppm = false; ///< P3 instead of P6
    int jpeg_quality = 95;  ///< 1 to 100
};

/// Writes a linear RGB image in the format of the file extension. The formats .png, .jpg/.jpeg, .tga and .ppm store 8
/// bits, encoded by the sRGB curve and rounded to nearest; NaN becomes 0 there. The formats .pfm, .hdr and .exr store
/// linear values. The file is written atomically: it is complete or absent. Throws an Error with exit code 2 for an
/// unknown extension, and with exit code 1 if writing fails.
void write_image(const std::filesystem::path& path, const ImageRgb& image, const WriteOptions& options = {});
/// Throws an Error unless write_image supports the path's extension, its folder exists and the path is not a folder.
/// Programs call this check before a long render.
void check_writable_image(const std::filesystem::path& path);

/// A named channel of an EXR file (for example "R", "depth.Z" or "hit.object") stores either floats or 32-bit unsigned
/// integers.
struct ExrChannel {
    std::string name;
    std::vector<float> floats;           ///< width × height values, or empty
    std::vector<std::uint32_t> integers; ///< width × height values, or empty
};
/// Returns the three channels of an image, named prefix + "R", prefix + "G" and prefix + "B".
std::vector<ExrChannel> rgb_channels(const std::string& prefix, const ImageRgb& image);
/// A text attribute is stored in the header of an EXR file, for example under the name "duet:scene".
struct ExrAttribute {
    std::string name, value;
};
/// Writes an EXR file with lossless ZIP compression. Each channel must have width × height values. The file is written
/// atomically: it is complete or absent. Throws an Error (exit code 1) if writing fails.
void write_exr(const std::filesystem::path& path, int width, int height, const std::vector<ExrChannel>& channels,
               const std::vector<ExrAttribute>& attributes = {});
/// Holds all channels of an EXR file inside its data window, and its text attributes. Half floats are converted to
/// floats.
struct ExrFile {
    int width = 0, height = 0;
    std::vector<ExrChannel> channels;
    std::vector<ExrAttribute> attributes;
};
/// Reads all channels of an EXR file. Throws an Error if the file cannot be read or is malformed, has several parts or
/// deep pixels, or has a subsampled channel.
ExrFile read_exr(const std::filesystem::path& path);

} // namespace duet
