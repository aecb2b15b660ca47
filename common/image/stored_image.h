// This file defines the values of image files as stored, and the limits of their sizes.
#pragma once

#include "common/image/image.h"
#include "common/image/view_transform.h"

#include <cstdint>
#include <string>
#include <string_view>
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

    /// Returns how many values an image of this size has.
    std::size_t value_count() const {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * static_cast<std::size_t>(channels);
    }
};

/// These limits apply to the width, the height and the number of pixels (about 1 GiB as RGB floats) of image files. A
/// file whose header claims more is rejected before any memory is allocated.
inline constexpr int kMaxImageSide = 32768;
inline constexpr long long kMaxImagePixels = 90'000'000;
/// This limits the bytes of all channels of an EXR file, so that the largest film (raytrace --film) can be read again.
inline constexpr double kMaxExrBytes = 0x1p33;

/// Holds the options of the formats that have any.
struct WriteOptions {
    bool ascii_ppm = false; ///< P3 instead of P6
    int jpeg_quality = 95;  ///< 1 to 100
    ViewTransform view{};   ///< how 8-bit files show radiance; files of linear values do not use it
};

/// A named channel of an EXR file (for example "R", "depth.Z" or "hit.object") stores either floats or 32-bit unsigned
/// integers.
struct ExrChannel {
    std::string name;
    std::vector<float> floats;           ///< width × height values, or empty
    std::vector<std::uint32_t> integers; ///< width × height values, or empty
};
/// A text attribute is stored in the header of an EXR file, for example under the name "duet:scene".
struct ExrAttribute {
    std::string name, value;
};
/// Holds all channels of an EXR file inside its data window, and its text attributes. Half floats are converted to
/// floats.
struct ExrFile {
    int width = 0, height = 0;
    std::vector<ExrChannel> channels;
    std::vector<ExrAttribute> attributes;
};
/// Holds the bytes of an image file and the name that error messages use for it, which is its path.
struct ImageBytes {
    std::string name;
    std::string_view bytes;
};

/// ImageSize is a width and height in pixels.
struct ImageSize {
    int width, height;
};

/// Throws an Error unless both sides are in [1, kMaxImageSide] and the image has at most kMaxImagePixels pixels.
void check_image_size(const std::string& name, long long width, long long height);
/// Throws an Error with exit code 1 unless both sides are in [1, kMaxImageSide]. An image of any number of pixels can
/// be written, because the program has computed it already, but one of more than kMaxImagePixels cannot be read again.
void check_written_size(const std::string& name, int width, int height);
/// Throws an Error if needed > available. `needed` is the smallest number of bytes that can store an image of the size
/// in the header, and `available` is the number of bytes in the file. The check prevents allocations for pixels that
/// the file does not contain.
void check_pixel_data_size(const ImageBytes& file, long long width, long long height, double needed, double available);

} // namespace duet
