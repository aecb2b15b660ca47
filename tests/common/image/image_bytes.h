// This header builds image files byte by byte, including files that no writer of ours produces, and returns the error
// of the reader.
#pragma once

#include "common/image/image_file.h"
#include "tests/support/errors.h"
#include "tests/support/scratch.h"

#include <doctest/doctest.h>

#include <string>

namespace duet::test {

inline std::string error_of_bytes(const std::filesystem::path& path, const std::string& bytes) {
    write_file(path, bytes);
    const std::string error = error_of([&] { read_stored_image(path); });
    if (error != "no error") {
        CHECK(error.starts_with(path.string() + ": "));
        CHECK(error.find('\n') == std::string::npos); // a single line
    }
    return error;
}

inline std::string big_endian(std::uint32_t value) {
    std::string text;
    for (int shift = 24; shift >= 0; shift -= 8) text += static_cast<char>(value >> shift & 255u);
    return text;
}

inline std::string png_chunk(const std::string& type_and_data) {
    std::uint32_t crc = 0xffffffffu;
    for (const char c : type_and_data) {
        crc ^= static_cast<unsigned char>(c);
        for (int bit = 0; bit < 8; ++bit) crc = (crc & 1) != 0 ? 0xedb88320u ^ crc >> 1 : crc >> 1;
    }
    return big_endian(static_cast<std::uint32_t>(type_and_data.size() - 4)) + type_and_data + big_endian(~crc);
}

inline const std::string kPngSignature = "\x89PNG\r\n\x1a\n";

// The pixels are in stored zlib blocks (RFC 1950, 1951). The zlib checksum is wrong on purpose, because our reader
// does not check it.
inline std::string png(std::uint32_t width, std::uint32_t height, int depth, int colour_type,
                       const std::string& pixels) {
    const auto size = static_cast<unsigned>(pixels.size());
    std::string data = "IDAT\x78\x01\x01";
    for (const unsigned part : {size & 255u, size >> 8, ~size & 255u, ~size >> 8 & 255u})
        data += static_cast<char>(part);
    const std::string header = "IHDR" + big_endian(width) + big_endian(height) + static_cast<char>(depth) +
                               static_cast<char>(colour_type) + std::string(3, '\0');
    return kPngSignature + png_chunk(header) + png_chunk(data + pixels + big_endian(0)) + png_chunk("IEND");
}

inline std::string hdr(const std::string& size, const std::string& pixels) {
    return "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + size + "\n" + pixels;
}

inline std::string tga(int type, int width, int height, int bits, const std::string& pixels) {
    std::string file(18, '\0');
    file[2] = static_cast<char>(type);
    file[12] = static_cast<char>(width & 255);
    file[13] = static_cast<char>(width >> 8);
    file[14] = static_cast<char>(height & 255);
    file[15] = static_cast<char>(height >> 8);
    file[16] = static_cast<char>(bits);
    return file + pixels;
}

} // namespace duet::test
