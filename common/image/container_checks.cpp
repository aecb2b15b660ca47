#include "common/image/container_checks.h"

#include <array>

namespace duet {

namespace {

std::uint32_t big_endian_16(std::string_view bytes, std::size_t i) {
    return byte_at(bytes, i) << 8 | byte_at(bytes, i + 1);
}
std::uint32_t big_endian_32(std::string_view bytes, std::size_t i) {
    return big_endian_16(bytes, i) << 16 | big_endian_16(bytes, i + 2);
}

constexpr std::array<std::uint32_t, 256> kCrcTable = [] {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t i = 0; i < table.size(); ++i) {
        std::uint32_t c = i;
        for (int bit = 0; bit < 8; ++bit) c = (c & 1) != 0 ? 0xedb88320u ^ c >> 1 : c >> 1;
        table[i] = c;
    }
    return table;
}();

std::uint32_t crc32(std::string_view bytes) {
    std::uint32_t c = 0xffffffffu;
    for (const char byte : bytes) c = kCrcTable[(c ^ static_cast<unsigned char>(byte)) & 255] ^ c >> 8;
    return ~c;
}

// Throws an Error if `pixel_bytes` bytes of compressed pixels are too few for the image size in the header chunk.
// `header` is that chunk's data (13 bytes). The compression ratio of deflate is at most 1032:1.
void check_png_size(const ImageBytes& file, std::string_view header, std::size_t pixel_bytes) {
    const long long width = big_endian_32(header, 0), height = big_endian_32(header, 4);
    check_image_size(file.name, width, height);
    constexpr std::array<double, 7> kChannels{1, 0, 3, 1, 2, 0, 4}; // channels by color type
    const double channels = byte_at(header, 9) < kChannels.size() ? kChannels[byte_at(header, 9)] : 0;
    const double bytes = static_cast<double>(width * height) * channels * byte_at(header, 8) / 8;
    check_pixel_data_size(file, width, height, bytes / 1032, static_cast<double>(pixel_bytes));
}

// Throws an Error for a Huffman table of more than 256 codes, the capacity of stb's tables; the standard allows 255
// (ITU-T T.81, §B.2.4.2). Like stb, the loop also reads a table that extends beyond the end of its segment.
void check_huffman_tables(const ImageBytes& file, std::size_t at, std::size_t end) {
    while (at < end) {
        std::uint32_t codes = 0;
        for (std::size_t i = at + 1; i < at + 17 && i < file.bytes.size(); ++i) codes += byte_at(file.bytes, i);
        if (codes > 256)
            throw Error(message(file.name, ": corrupt: a Huffman table of ", codes, " codes, expected at most 256"));
        at += 17 + codes;
    }
}

// Checks the image size in a frame header. `at` is the offset of the header's data, which starts with the bit depth,
// the height and the width.
void check_jpeg_size(const ImageBytes& file, std::size_t at) {
    const long long height = big_endian_16(file.bytes, at + 1), width = big_endian_16(file.bytes, at + 3);
    check_image_size(file.name, width, height);
    // A block of 8 x 8 values takes at least one bit. If all channels are subsampled, it covers the area of at most 16
    // blocks.
    check_pixel_data_size(file, width, height, static_cast<double>(width * height) / (64 * 16 * 8),
                          static_cast<double>(file.bytes.size()));
}

bool is_frame(std::uint32_t marker) {
    return marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
}

} // namespace

// A PNG is a sequence of chunks. Each chunk consists of length, type, data and checksum (ISO/IEC 15948, §5; Annex D
// defines the checksum).
void check_png(const ImageBytes& file) {
    constexpr std::size_t kSignature = 8, kFrame = 12;
    std::size_t pixel_bytes = 0;
    std::string_view type;
    for (std::size_t at = kSignature; type != "IEND";) {
        const std::size_t left = file.bytes.size() - at;
        const std::size_t length = left < kFrame ? 0 : big_endian_32(file.bytes, at);
        if (left < kFrame || length > left - kFrame)
            throw Error(message(file.name, ": truncated: the file ends before its last chunk (IEND)"));
        type = file.bytes.substr(at + 4, 4);
        if (crc32(file.bytes.substr(at + 4, length + 4)) != big_endian_32(file.bytes, at + 8 + length))
            throw Error(message(file.name, ": corrupt: wrong checksum in the chunk at byte ", at));
        const bool first = at == kSignature;
        if (first != (type == "IHDR") || (first && length != 13))
            throw Error(message(file.name, ": corrupt: the header (IHDR) is not where it belongs"));
        if (type == "IDAT") pixel_bytes += length;
        at += kFrame + length;
    }
    check_png_size(file, file.bytes.substr(kSignature + 8, 13), pixel_bytes);
}

// A JPEG is a sequence of segments, which begin with 0xff and a marker and may have padding between them. The data of a
// scan follow the scan's header; in these data, 0xff is followed by 0 or a restart marker (ITU-T T.81, §B.1.1).
void check_jpeg(const ImageBytes& file) {
    constexpr std::uint32_t kTables = 0xc4, kFirstRestart = 0xd0, kLastRestart = 0xd7, kEnd = 0xd9;
    bool has_frame = false;
    for (std::size_t at = file.bytes.find('\xff', 2); at != std::string_view::npos; at = file.bytes.find('\xff', at)) {
        at = file.bytes.find_first_not_of('\xff', at);
        if (at == std::string_view::npos) break;
        const std::uint32_t marker = byte_at(file.bytes, at++);
        if (marker == 0 || (marker >= kFirstRestart && marker <= kLastRestart)) continue;
        if (marker == kEnd && has_frame) return;
        const std::size_t left = file.bytes.size() - at, length = left < 2 ? 2 : big_endian_16(file.bytes, at);
        if (left < 2 || length > left) break;
        if (length < 2)
            throw Error(message(file.name, ": corrupt: a segment of ", length, " bytes, expected 2 or more"));
        if (marker == kTables) check_huffman_tables(file, at + 2, at + length);
        if (is_frame(marker)) {
            if (length < 8) throw Error(message(file.name, ": corrupt: a frame header of ", length, " bytes"));
            check_jpeg_size(file, at + 2);
            has_frame = true;
        }
        at += length;
    }
    throw Error(
        message(file.name, ": truncated: the file ends before its ", has_frame ? "end marker (EOI)" : "frame (SOF)"));
}

} // namespace duet
