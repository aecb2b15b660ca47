// Reading and writing picture files: PNG, JPEG, TGA, PPM (P3, P6), PFM, HDR (Radiance) and EXR.
#pragma once

#include "common/image/image.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace duet {

/// A file's values as stored: `channels` (1 to 4) floats a pixel, interleaved, rows from the top.
struct PixelFile {
    /// What the values mean. `kEncoded`: sRGB-encoded, 8 or 16 bits scaled to [0, 1] (PNG, JPEG, TGA, PPM; a fourth
    /// or second channel is linear alpha). `kLinear`: linear radiance, any value (PFM, HDR, EXR).
    enum class Encoding { kEncoded, kLinear };

    int width = 0, height = 0, channels = 0;
    Encoding encoding = Encoding::kLinear;
    std::vector<float> values;
};

/// The largest width or height that is read, and the largest number of pixels (1 GiB as RGB floats): a file that claims
/// more is refused from its header, before any memory is taken.
inline constexpr int kMaxImageSide = 32768;
inline constexpr long long kMaxImagePixels = 90'000'000;

/// The whole file, by its content, not its ending (TGA, which has no signature: by its ending). An EXR's R, G, B (or Y)
/// and A channels are read, of its data window (wherever that lies). Throws Error (path, what was found, what was
/// expected) where the file is missing, truncated, malformed or over the limits.
PixelFile read_pixel_file(const std::filesystem::path& path);

/// The picture as linear RGB: encoded values are decoded by the sRGB curve, grey is spread, alpha is dropped.
ImageRgb to_linear(const PixelFile& file);
/// to_linear(read_pixel_file(path)).
ImageRgb read_image(const std::filesystem::path& path);

struct WriteOptions {
    bool ascii_ppm = false; ///< P3 instead of P6
    int jpeg_quality = 95;  ///< 1 to 100
};

/// Writes linear RGB by the path's ending: .png, .jpg/.jpeg, .tga, .ppm (8 bits, encoded by the sRGB curve, rounded to
/// nearest), .pfm, .hdr, .exr (linear). The file is whole or absent: it is written beside and renamed. Throws Error
/// with exit code 2 for an unknown ending and 1 where writing fails. NaN is written as 0 to 8-bit files.
void write_image(const std::filesystem::path& path, const ImageRgb& image, const WriteOptions& options = {});
/// Throws Error unless write_image knows the path's ending and its folder exists: called before a long render.
void check_writable_image(const std::filesystem::path& path);

/// One named channel of an EXR file ("R", "depth.Z", "normal.X", "hit.object" …): floats, or 32-bit unsigned integers.
struct ExrChannel {
    std::string name;
    std::vector<float> floats;           ///< width × height values, or empty
    std::vector<std::uint32_t> integers; ///< width × height values, or empty
};
/// The three channels PREFIX + "R", "G", "B" of a picture.
std::vector<ExrChannel> rgb_channels(const std::string& prefix, const ImageRgb& image);
/// String attributes are stored in the header ("duet:scene" …).
struct ExrAttribute {
    std::string name, value;
};
/// Writes channels of equal size, lossless (ZIP), whole or absent. Throws Error (exit code 1) where writing fails.
void write_exr(const std::filesystem::path& path, int width, int height, const std::vector<ExrChannel>& channels,
               const std::vector<ExrAttribute>& attributes = {});
/// All channels of an EXR file's data window, half floats widened; of one part, flat, each channel with a value a
/// pixel.
struct ExrFile {
    int width = 0, height = 0;
    std::vector<ExrChannel> channels;
    std::vector<ExrAttribute> attributes;
};
ExrFile read_exr(const std::filesystem::path& path);

} // namespace duet
