#include "common/image/image_file.h"

#include "common/image/formats.h"
#include "common/image/srgb.h"
#include "common/system/file.h"
#include "common/system/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace duet {

namespace fs = std::filesystem;
using namespace std::string_view_literals;

namespace {

struct Reader {
    std::string_view signature;
    StoredImage (*decode)(const ImageBytes&);
};
constexpr std::array kReaders{
    Reader{"\x89PNG\r\n\x1a\n"sv, decode_png},
    Reader{"\xff\xd8\xff"sv, decode_jpeg},
    Reader{"P3"sv, decode_ppm},
    Reader{"P6"sv, decode_ppm},
    Reader{"PF"sv, decode_pfm},
    Reader{"Pf"sv, decode_pfm},
    Reader{"#?"sv, decode_hdr},
    Reader{"\x76\x2f\x31\x01"sv, decode_exr},
};

struct Writer {
    std::string_view extension;
    std::string (*encode)(const ImageRgb&, const WriteOptions&);
};
// EXR has no encoder here, because OpenEXR writes files directly.
constexpr std::array kWriters{
    Writer{".png", encode_png}, Writer{".jpg", encode_jpeg}, Writer{".jpeg", encode_jpeg}, Writer{".tga", encode_tga},
    Writer{".ppm", encode_ppm}, Writer{".pfm", encode_pfm},  Writer{".hdr", encode_hdr},   Writer{".exr", nullptr},
};

const Writer& find_writer(const fs::path& path) {
    const std::string extension = lower_case_extension(path);
    for (const Writer& writer : kWriters)
        if (writer.extension == extension) return writer;
    throw Error(message(path.string(), ": ", extension.empty() ? "no ending" : "unknown ending " + extension,
                        ", expected .png, .jpg, .jpeg, .tga, .ppm, .pfm, .hdr or .exr"));
}

// Decodes sRGB-encoded values. A table serves the 256 values k/255 of 8-bit files; in 16-bit files, k·257/65535 is the
// same float. The transfer curve is evaluated for all other values.
class SrgbDecoder {
public:
    SrgbDecoder() {
        for (std::size_t k = 0; k < table_.size(); ++k) table_[k] = srgb_decode_8bit(static_cast<std::uint8_t>(k));
    }
    float operator()(float encoded) const {
        const float code = std::nearbyint(encoded * 255.0f);
        const bool in_table = code >= 0.0f && code <= 255.0f && code / 255.0f == encoded;
        return in_table ? table_[static_cast<std::size_t>(code)] : srgb_decode(encoded);
    }

private:
    std::array<float, 256> table_{};
};

} // namespace

StoredImage decode_image(const ImageBytes& file, const std::string& extension) {
    if (file.bytes.empty()) throw Error(message(file.name, ": empty file, expected an image"));
    for (const Reader& reader : kReaders)
        if (file.bytes.starts_with(reader.signature)) return reader.decode(file);
    if (extension == ".tga") return decode_tga(file);
    throw Error(message(file.name, ": unknown format, expected a PNG, JPEG, TGA, PPM (P3, P6), PFM, HDR or EXR image"));
}

std::vector<ExrChannel> rgb_channels(const std::string& prefix, const ImageRgb& image) {
    return {exr_channel(prefix + "R", image, &Rgb::r), exr_channel(prefix + "G", image, &Rgb::g),
            exr_channel(prefix + "B", image, &Rgb::b)};
}

ImageRgb rgb_image(const std::string& prefix, const ExrFile& file) {
    ImageRgb image(file.width, file.height);
    for (std::size_t c = 0; c < 3; ++c) {
        const auto channel = std::ranges::find(file.channels, prefix + "RGB"[c], &ExrChannel::name);
        if (channel == file.channels.end() || channel->floats.size() != image.size()) return {};
        for (std::size_t i = 0; i < image.size(); ++i) image[i][c] = channel->floats[i];
    }
    return image;
}

StoredImage read_stored_image(const fs::path& path) {
    const std::string bytes = read_file(path);
    return decode_image({path.string(), bytes}, lower_case_extension(path));
}

ImageRgb to_linear(const StoredImage& file) {
    const SrgbDecoder decode;
    ImageRgb image(file.width, file.height);
    const auto channels = static_cast<std::size_t>(file.channels), width = static_cast<std::size_t>(file.width);
    DUET_CHECK_EQ(file.values.size(), file.value_count());
    const bool gray = channels < 3, encoded = file.encoding == StoredImage::Encoding::kEncoded;
    parallel_for(static_cast<std::size_t>(file.height), 0, [&](std::size_t y) {
        for (std::size_t i = y * width; i < (y + 1) * width; ++i) {
            const float* value = &file.values[i * channels];
            const Rgb stored = gray ? Rgb(value[0]) : Rgb(value[0], value[1], value[2]);
            image[i] = encoded ? Rgb(decode(stored.r), decode(stored.g), decode(stored.b)) : stored;
        }
    });
    return image;
}

ImageRgb read_image(const fs::path& path) { return to_linear(read_stored_image(path)); }

void write_image(const fs::path& path, const ImageRgb& image, const WriteOptions& options) {
    const Writer& writer = find_writer(path);
    check_written_size(path.string(), image.width(), image.height());
    if (writer.encode == nullptr)
        write_exr(path, image.width(), image.height(), rgb_channels("", image));
    else
        write_file(path, writer.encode(image, options));
}

void check_writable_image(const fs::path& path) {
    find_writer(path);
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    std::error_code error;
    if (!fs::is_directory(folder, error)) throw Error(message(path.string(), ": no folder ", folder.string()));
    if (fs::is_directory(path, error)) throw Error(message(path.string(), ": is a folder, expected a file's name"));
}

} // namespace duet
