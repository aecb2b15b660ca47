// These functions read and write image files: PNG, JPEG, TGA, PPM (P3, P6), PFM, HDR (Radiance) and EXR.
#pragma once

#include "common/image/stored_image.h"

#include <filesystem>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace duet {

/// Reads an image file. Its signature determines the format, not the file extension; TGA has no signature and is chosen
/// by its extension. Of an EXR file, the channels R, G, B (or Y) and A are read inside the data window, wherever that
/// lies. Throws an Error that names the path, what was found and what was expected if the file is missing, truncated,
/// malformed or over the limits.
StoredImage read_stored_image(const std::filesystem::path& path);

/// Decodes an image file in the format of its signature. TGA has no signature; it is chosen if `extension` is ".tga".
/// Throws an Error for an unknown format or a malformed file.
StoredImage decode_image(const ImageBytes& file, const std::string& extension);

/// Converts the values of a file to linear RGB. Encoded values are decoded by the sRGB curve, gray is copied to all
/// three channels, and alpha is dropped.
ImageRgb to_linear(const StoredImage& file);
/// Returns to_linear(read_stored_image(path)).
ImageRgb read_image(const std::filesystem::path& path);

/// Writes a linear RGB image in the format of the file extension. The formats .png, .jpg/.jpeg, .tga and .ppm store 8
/// bits: the image after the view transform, encoded by the sRGB curve; NaN becomes 0 there. The formats .pfm, .hdr and
/// .exr store linear values. The file is written atomically: it is complete or absent. Throws an Error with exit code 2
/// for an unknown extension, and with exit code 1 if writing fails.
void write_image(const std::filesystem::path& path, const ImageRgb& image, const WriteOptions& options = {});
/// Throws an Error unless write_image supports the path's extension, its folder exists and the path is not a folder.
/// Programs call this check before a long render.
void check_writable_image(const std::filesystem::path& path);

/// Returns a channel with the value get(pixel) of each pixel, a float or an unsigned integer. `get` may be a pointer to
/// a member.
template <typename Pixel, typename Get>
ExrChannel exr_channel(std::string name, const Image<Pixel>& image, const Get& get) {
    using Value = std::remove_cvref_t<std::invoke_result_t<const Get&, const Pixel&>>;
    std::vector<Value> values;
    values.reserve(image.size());
    for (const Pixel& pixel : image) values.push_back(std::invoke(get, pixel));
    if constexpr (std::is_same_v<Value, float>)
        return {std::move(name), std::move(values), {}};
    else
        return {std::move(name), {}, std::move(values)};
}
/// Returns the three channels of an image, named prefix + "R", prefix + "G" and prefix + "B".
std::vector<ExrChannel> rgb_channels(const std::string& prefix, const ImageRgb& image);
/// Writes an EXR file with lossless ZIP compression. Each channel must have width × height values. The file is written
/// atomically: it is complete or absent. Throws an Error (exit code 1) if writing fails.
void write_exr(const std::filesystem::path& path, int width, int height, const std::vector<ExrChannel>& channels,
               const std::vector<ExrAttribute>& attributes = {});
/// Reads all channels of an EXR file. Throws an Error if the file cannot be read or is malformed, has several parts or
/// deep pixels, or has a subsampled channel.
ExrFile read_exr(const std::filesystem::path& path);
/// Returns the image of the three channels that rgb_channels names so; empty if one of them is missing.
ImageRgb rgb_image(const std::string& prefix, const ExrFile& file);

} // namespace duet
