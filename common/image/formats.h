// Each image format has a decoder and an encoder, which convert between bytes in memory and pixels. Callers outside
// this folder use image_file.h.
#pragma once

#include "common/image/stored_image.h"

namespace duet {

/// Returns byte i, which must exist.
inline std::uint32_t byte_at(std::string_view bytes, std::size_t i) { return static_cast<unsigned char>(bytes[i]); }

/// The stb library implements these formats. The decoders throw Error for a file that is malformed or over the limits;
/// the encoders return the bytes of a file.
///@{
StoredImage decode_png(const ImageBytes& file);
StoredImage decode_jpeg(const ImageBytes& file);
StoredImage decode_tga(const ImageBytes& file);
std::string encode_png(const ImageRgb& image, const WriteOptions& options);
std::string encode_jpeg(const ImageRgb& image, const WriteOptions& options);
std::string encode_tga(const ImageRgb& image, const WriteOptions& options);
///@}

/// The project implements these formats itself. As above, the decoders throw Error for a file that is malformed or over
/// the limits, and the encoders return the bytes of a file. @{
StoredImage decode_ppm(const ImageBytes& file);
StoredImage decode_pfm(const ImageBytes& file);
StoredImage decode_hdr(const ImageBytes& file);
std::string encode_ppm(const ImageRgb& image, const WriteOptions& options);
std::string encode_pfm(const ImageRgb& image, const WriteOptions& options);
std::string encode_hdr(const ImageRgb& image, const WriteOptions& options);
///@}

/// Decodes the color channels of an EXR file by the OpenEXR library. Throws Error for a file that is malformed or over
/// the limits.
StoredImage decode_exr(const ImageBytes& file);
/// Decodes all channels of an EXR file.
ExrFile decode_exr_channels(const ImageBytes& file);

} // namespace duet
