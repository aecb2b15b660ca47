// Each image format has a decoder and an encoder, which convert between bytes in memory and pixels. Callers outside
// this folder use image_file.h.
#pragma once

#include "common/image/image_file.h"

#include <string>
#include <string_view>

namespace duet {

/// Holds the bytes of an image file and the name that error messages use for it, which is its path.
struct ImageBytes {
    std::string name;
    std::string_view bytes;
};

/// Throws an Error with the given exit code unless both sides are in [1, kMaxImageSide] and the image has at most
/// kMaxImagePixels pixels.
void check_image_size(const std::string& name, long long width, long long height, int exit_code = 2);
/// Throws an Error if needed > available. `needed` is the smallest number of bytes that can store an image of the size
/// in the header, and `available` is the number of bytes in the file. The check prevents allocations for pixels that
/// the file does not contain.
void check_pixel_data_size(const ImageBytes& file, long long width, long long height, double needed, double available);

/// Decodes an image file in the format of its signature. TGA has no signature; it is chosen if `extension` is ".tga".
/// Throws an Error for an unknown format or a malformed file.
StoredImage decode_image(const ImageBytes& file, const std::string& extension);

// The stb library implements these formats.
StoredImage decode_png(const ImageBytes& file);
StoredImage decode_jpeg(const ImageBytes& file);
StoredImage decode_tga(const ImageBytes& file);
std::string encode_png(const ImageRgb& image, const WriteOptions& options);
std::string encode_jpeg(const ImageRgb& image, const WriteOptions& options);
std::string encode_tga(const ImageRgb& image, const WriteOptions& options);

// The project implements these formats itself.
StoredImage decode_ppm(const ImageBytes& file);
StoredImage decode_pfm(const ImageBytes& file);
StoredImage decode_hdr(const ImageBytes& file);
std::string encode_ppm(const ImageRgb& image, const WriteOptions& options);
std::string encode_pfm(const ImageRgb& image, const WriteOptions& options);
std::string encode_hdr(const ImageRgb& image, const WriteOptions& options);

// The OpenEXR library implements this format.
StoredImage decode_exr(const ImageBytes& file);
ExrFile decode_exr_channels(const ImageBytes& file);

} // namespace duet
