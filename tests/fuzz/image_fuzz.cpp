// This fuzz target decodes any bytes as an image. Each reader must return pixels or throw Error, nothing else.
#include "common/image/image_file.h"

#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const duet::ImageBytes file{"fuzz", {reinterpret_cast<const char*>(data), size}};
    try {
        // A file without a signature is decoded as a TGA.
        const duet::StoredImage shown_image = duet::decode_image(file, ".tga");
        const std::size_t pixels =
            static_cast<std::size_t>(shown_image.width) * static_cast<std::size_t>(shown_image.height);
        if (shown_image.width < 1 || shown_image.height < 1 || shown_image.channels < 1 || shown_image.channels > 4 ||
            shown_image.values.size() != pixels * static_cast<std::size_t>(shown_image.channels))
            std::abort();
    } catch (const duet::Error&) {
    }
    if (file.bytes.starts_with("\x76\x2f\x31\x01")) {
        try {
            duet::decode_exr_channels(file);
        } catch (const duet::Error&) {
        }
    }
    return 0;
}

// PNG checksums would reject nearly every mutated input before it is decoded, so they are corrected first.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
    size = LLVMFuzzerMutate(data, size, max_size);
    const auto byte_at = [&](std::size_t i) { return static_cast<std::uint32_t>(data[i]); };
    const std::uint8_t signature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    if (size < sizeof signature || seed % 16 == 0) return size;
    for (std::size_t i = 0; i < sizeof signature; ++i)
        if (data[i] != signature[i]) return size;
    for (std::size_t at = 8; at + 12 <= size;) {
        const std::size_t length = byte_at(at) << 24 | byte_at(at + 1) << 16 | byte_at(at + 2) << 8 | byte_at(at + 3);
        if (length > size - at - 12) break;
        std::uint32_t crc = 0xffffffffu;
        for (std::size_t i = at + 4; i < at + 8 + length; ++i) {
            crc ^= data[i];
            for (int bit = 0; bit < 8; ++bit) crc = (crc & 1) != 0 ? 0xedb88320u ^ crc >> 1 : crc >> 1;
        }
        for (unsigned i = 0; i < 4; ++i) data[at + 8 + length + i] = static_cast<std::uint8_t>(~crc >> (24 - 8 * i));
        at += 12 + length;
    }
    return size;
}
