// One decoder and one encoder a picture format, between bytes in memory and pixels. image_file.h is what callers use.
#pragma once

#include "common/image/image_file.h"

#include <string>
#include <string_view>

namespace duet {

/// A picture file's bytes and what errors call it: its path.
struct ImageBytes {
    std::string name;
    std::string_view bytes;
};

/// Throws Error unless a picture of that size may be read or written: sides 1 to kMaxImageSide, at most
/// kMaxImagePixels.
void check_image_size(const std::string& name, long long width, long long height, int exit_code = 2);
/// Throws Error where `needed` bytes, the least that the size claimed in a header can be stored in, are more than the
/// file has: so no memory is taken for a picture that isn't there.
void check_claim(const ImageBytes& file, long long width, long long height, double needed, double available);

/// The whole file, by its signature; TGA, which has none, where `ending` is ".tga". Throws Error.
PixelFile decode_image(const ImageBytes& file, const std::string& ending);

// Through stb.
PixelFile decode_png(const ImageBytes& file);
PixelFile decode_jpeg(const ImageBytes& file);
PixelFile decode_tga(const ImageBytes& file);
std::string encode_png(const ImageRgb& image, const WriteOptions& options);
std::string encode_jpeg(const ImageRgb& image, const WriteOptions& options);
std::string encode_tga(const ImageRgb& image, const WriteOptions& options);

// By our own code.
PixelFile decode_ppm(const ImageBytes& file);
PixelFile decode_pfm(const ImageBytes& file);
PixelFile decode_hdr(const ImageBytes& file);
std::string encode_ppm(const ImageRgb& image, const WriteOptions& options);
std::string encode_pfm(const ImageRgb& image, const WriteOptions& options);
std::string encode_hdr(const ImageRgb& image, const WriteOptions& options);

// Through OpenEXR.
PixelFile decode_exr(const ImageBytes& file);
ExrFile decode_exr_channels(const ImageBytes& file);

} // namespace duet
