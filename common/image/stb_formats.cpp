// This file reads and writes PNG, JPEG and TGA files with stb. container_checks.h checks files first for the errors
// that stb does not detect.
#include "common/image/container_checks.h"
#include "common/image/formats.h"

#include <cstdlib>

// stb uses tables that a JPEG never defined, and leaves pixels unwritten if their data are missing. The allocator
// clears memory, so that both read as zero instead of uninitialized memory.
#define STBI_MALLOC(size) std::calloc(1, size)
#define STBI_REALLOC(pointer, size) std::realloc(pointer, size)
#define STBI_FREE(pointer) std::free(pointer)
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_TGA
#define STBI_NO_STDIO
#define STBI_NO_LINEAR
#define STBI_MAX_DIMENSIONS 32768
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
// GCC warns about unused functions of stb although its include folder is a SYSTEM one.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb_image.h>
#include <stb_image_write.h>
#pragma GCC diagnostic pop

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>

namespace duet {

namespace {

static_assert(STBI_MAX_DIMENSIONS == kMaxImageSide);

// Decoding -----------------------------------------------------------------------------------------------------------

// Provides the bytes of a file to stb and detects reads beyond its end. stb reads in two ways. It fills a buffer of 128
// bytes, where a short read at the end of the file is normal, or it reads into its own memory, where a short read means
// that the file is truncated.
class Source {
public:
    explicit Source(std::string_view bytes) : bytes_(bytes) {}

    bool ended_early() const { return ended_early_; }

    static stbi_io_callbacks callbacks() {
        return {[](void* source, char* data, int size) { return static_cast<Source*>(source)->read(data, size); },
                [](void* source, int count) { static_cast<Source*>(source)->skip(count); },
                [](void* source) { return static_cast<Source*>(source)->at_end() ? 1 : 0; }};
    }

private:
    static constexpr std::size_t kBufferSize = sizeof(stbi__context::buffer_start);

    int read(char* data, int size) {
        const std::size_t wanted = static_cast<std::size_t>(std::max(size, 0)),
                          count = std::min(wanted, bytes_.size() - at_);
        if (count < wanted && (wanted != kBufferSize || count == 0)) ended_early_ = true;
        std::memcpy(data, bytes_.data() + at_, count);
        at_ += count;
        return static_cast<int>(count);
    }
    void skip(int count) {
        const std::size_t wanted = static_cast<std::size_t>(std::max(count, 0));
        if (wanted > bytes_.size() - at_) ended_early_ = true;
        at_ += std::min(wanted, bytes_.size() - at_);
    }
    bool at_end() const { return at_ == bytes_.size(); }

    std::string_view bytes_;
    std::size_t at_ = 0;
    bool ended_early_ = false;
};

[[noreturn]] void stb_failed(const ImageBytes& file, const char* format, const Source& source) {
    const char* reason = stbi_failure_reason();
    throw Error(message(file.name, ": not a readable ", format, " image: ",
                        source.ended_early() ? "truncated"
                        : reason != nullptr  ? reason
                                             : "unknown reason"));
}

struct Size {
    int width = 0, height = 0, channels = 0;
};

Size stb_size(const ImageBytes& file, const char* format) {
    if (file.bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
        throw Error(message(file.name, ": ", file.bytes.size(), " bytes, expected less than 2 GiB"));
    Size size;
    Source source(file.bytes);
    const stbi_io_callbacks callbacks = Source::callbacks();
    if (stbi_info_from_callbacks(&callbacks, &source, &size.width, &size.height, &size.channels) == 0)
        stb_failed(file, format, source);
    check_image_size(file.name, size.width, size.height);
    return size;
}

template <typename Sample, typename Load>
StoredImage decode_with(Load load, const ImageBytes& file, const char* format) {
    StoredImage image;
    image.encoding = StoredImage::Encoding::kEncoded;
    Source source(file.bytes);
    const stbi_io_callbacks callbacks = Source::callbacks();
    const std::unique_ptr<Sample, decltype(&stbi_image_free)> samples(
        load(&callbacks, &source, &image.width, &image.height, &image.channels, 0), stbi_image_free);
    if (!samples || source.ended_early()) stb_failed(file, format, source);
    const std::size_t count = image.value_count();
    image.values.reserve(count);
    for (std::size_t i = 0; i < count; ++i)
        image.values.push_back(static_cast<float>(samples.get()[i]) /
                               static_cast<float>(std::numeric_limits<Sample>::max()));
    return image;
}

// Returns the smallest number of bytes that the pixels of a TGA can take. They are stored one by one or in runs of up
// to 128 (Truevision TGA, Version 2.0, "Data Types").
double min_tga_bytes(const ImageBytes& file, const Size& size) {
    const double pixels = static_cast<double>(size.width) * size.height;
    const bool runs = (byte_at(file.bytes, 2) & 8) != 0;
    const double bytes_per_pixel = (byte_at(file.bytes, 16) + 7) / 8;
    return runs ? pixels / 128 * (1 + bytes_per_pixel) : pixels * bytes_per_pixel;
}

// Encoding -----------------------------------------------------------------------------------------------------------

void append(void* file, void* data, int size) {
    static_cast<std::string*>(file)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
}

template <typename Write>
std::string encode_with(Write write, const ImageRgb& image, const WriteOptions& options) {
    const std::vector<std::uint8_t> bytes = display_bytes(image, options.view);
    std::string file;
    if (write(&append, &file, image.width(), image.height(), 3, bytes.data()) == 0)
        throw Error("an image cannot be encoded: out of memory", 1);
    return file;
}

} // namespace

StoredImage decode_png(const ImageBytes& file) {
    check_png(file);
    stb_size(file, "PNG");
    // Byte 24 of the file is byte 8 of the header chunk's data: the bits per sample.
    return byte_at(file.bytes, 24) == 16 ? decode_with<stbi_us>(stbi_load_16_from_callbacks, file, "PNG")
                                         : decode_with<stbi_uc>(stbi_load_from_callbacks, file, "PNG");
}

StoredImage decode_jpeg(const ImageBytes& file) {
    check_jpeg(file);
    stb_size(file, "JPEG");
    return decode_with<stbi_uc>(stbi_load_from_callbacks, file, "JPEG");
}

StoredImage decode_tga(const ImageBytes& file) {
    // A TGA has the color map type 0 or 1. Other files must be rejected here, because stb might read them as JPEG
    // without the checks of check_jpeg().
    if (file.bytes.size() < 18 || byte_at(file.bytes, 1) > 1)
        throw Error(message(file.name, ": not a readable TGA image: no TGA header"));
    const Size size = stb_size(file, "TGA");
    check_pixel_data_size(file, size.width, size.height, min_tga_bytes(file, size),
                          static_cast<double>(file.bytes.size() - 18));
    return decode_with<stbi_uc>(stbi_load_from_callbacks, file, "TGA");
}

std::string encode_png(const ImageRgb& image, const WriteOptions& options) {
    const auto write = [](auto append_, void* file, int width, int height, int channels, const std::uint8_t* bytes) {
        return stbi_write_png_to_func(append_, file, width, height, channels, bytes, width * channels);
    };
    return encode_with(write, image, options);
}

std::string encode_jpeg(const ImageRgb& image, const WriteOptions& options) {
    const auto write = [&](auto append_, void* file, int width, int height, int channels, const std::uint8_t* bytes) {
        const int quality = std::clamp(options.jpeg_quality, 1, 100);
        return stbi_write_jpg_to_func(append_, file, width, height, channels, bytes, quality);
    };
    return encode_with(write, image, options);
}

std::string encode_tga(const ImageRgb& image, const WriteOptions& options) {
    return encode_with(stbi_write_tga_to_func, image, options);
}

} // namespace duet
