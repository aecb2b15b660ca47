#include "models/image.h"

#include "common/system/file.h"

#include <array>
#include <string>
#include <vector>

namespace duet::models {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Writes bits in DEFLATE's order: the least significant first, but Huffman codes from the most significant.
class BitWriter {
public:
    explicit BitWriter(Bytes& out) : out_(out) {}
    void bits(std::uint32_t value, int count) {
        for (int i = 0; i < count; ++i) bit(value >> i & 1);
    }
    void code(std::uint32_t value, int count) {
        for (int i = count - 1; i >= 0; --i) bit(value >> i & 1);
    }
    void finish() {
        while (used_ != 0) bit(0);
    }

private:
    void bit(std::uint32_t b) {
        current_ = static_cast<std::uint8_t>(current_ | b << used_);
        if (++used_ == 8) {
            out_.push_back(current_);
            current_ = 0;
            used_ = 0;
        }
    }
    Bytes& out_;
    std::uint8_t current_ = 0;
    int used_ = 0;
};

/// Writes a literal, an end of block (256) or a length code by the fixed code of RFC 1951, §3.2.6.
void write_symbol(BitWriter& out, std::uint32_t symbol) {
    if (symbol < 144)
        out.code(0x30 + symbol, 8);
    else if (symbol < 256)
        out.code(0x190 + symbol - 144, 9);
    else if (symbol < 280)
        out.code(symbol - 256, 7);
    else
        out.code(0xc0 + symbol - 280, 8);
}

constexpr std::size_t kShortest = 4, kLongest = 258, kWindow = 32768;

/// Writes lengths 3 … 258 as codes 257 … 285 and distances 1 … 32768 as codes 0 … 29. Each group of codes has
/// one more extra bit (RFC 1951, §3.2.5).
void write_match(BitWriter& out, std::size_t length, std::size_t distance) {
    if (length == kLongest)
        write_symbol(out, 285);
    else {
        std::uint32_t rest = static_cast<std::uint32_t>(length) - 3;
        int extra = 0;
        while (rest >> extra >= 8) ++extra;
        write_symbol(out, 257 + 4 * static_cast<std::uint32_t>(extra) + (rest >> extra));
        out.bits(rest & ((1u << extra) - 1), extra);
    }
    const std::uint32_t rest = static_cast<std::uint32_t>(distance) - 1;
    int extra = 0;
    while (rest >> extra >= 4) ++extra;
    out.code(2 * static_cast<std::uint32_t>(extra) + (rest >> extra), 5);
    out.bits(rest & ((1u << extra) - 1), extra);
}

/// Writes one DEFLATE block of fixed codes. A match is the most recent position with the same four bytes.
void deflate(const Bytes& data, Bytes& result) {
    BitWriter out(result);
    out.bits(1, 1); // last block
    out.bits(1, 2); // fixed codes
    std::vector<std::size_t> last_position(std::size_t{1} << 15, data.size());
    const auto hash = [&](std::size_t i) {
        const std::uint32_t four = static_cast<std::uint32_t>(data[i] | data[i + 1] << 8 | data[i + 2] << 16) |
                                   static_cast<std::uint32_t>(data[i + 3]) << 24;
        return four * 2654435761u >> 17;
    };
    for (std::size_t i = 0; i < data.size();) {
        std::size_t length = 0, from = data.size();
        if (i + kShortest <= data.size()) {
            from = last_position[hash(i)];
            if (from < i && i - from <= kWindow)
                while (length < kLongest && i + length < data.size() && data[from + length] == data[i + length])
                    ++length;
        }
        const bool match = length >= kShortest;
        if (match)
            write_match(out, length, i - from);
        else
            write_symbol(out, data[i]);
        for (const std::size_t end = i + (match ? length : 1); i < end; ++i)
            if (i + kShortest <= data.size()) last_position[hash(i)] = i;
    }
    write_symbol(out, 256);
    out.finish();
}

void append_big_endian(Bytes& out, std::uint32_t x) {
    for (const int shift : {24, 16, 8, 0}) out.push_back(static_cast<std::uint8_t>(x >> shift & 0xff));
}

/// Returns the CRC-32 of ISO 3309, as defined by annex D of PNG.
std::uint32_t crc32(const Bytes& bytes) {
    std::uint32_t crc = ~0u;
    for (const std::uint8_t byte : bytes) {
        crc ^= byte;
        for (int i = 0; i < 8; ++i) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0u);
    }
    return ~crc;
}

/// Returns the Adler-32 checksum of RFC 1950, §8.2.
std::uint32_t adler32(const Bytes& bytes) {
    std::uint32_t a = 1, b = 0;
    for (const std::uint8_t byte : bytes) {
        a = (a + byte) % 65521;
        b = (b + a) % 65521;
    }
    return b << 16 | a;
}

void append_chunk(Bytes& file, const char (&type)[5], const Bytes& data) {
    append_big_endian(file, static_cast<std::uint32_t>(data.size()));
    Bytes body(type, type + 4);
    body.insert(body.end(), data.begin(), data.end());
    file.insert(file.end(), body.begin(), body.end());
    append_big_endian(file, crc32(body));
}

void write_bytes(const std::filesystem::path& path, const Bytes& bytes) {
    write_file(path, std::string(bytes.begin(), bytes.end()));
}

/// Returns a color as three mantissas and a common exponent.
std::array<std::uint8_t, 4> rgbe(Rgb c) {
    const float largest = max_component(c);
    if (!(largest > 1e-32f)) return {0, 0, 0, 0};
    int exponent = 0;
    const float mantissa = std::frexp(largest, &exponent);
    const float scale = mantissa * 256 / largest;
    const auto byte = [&](float x) { return static_cast<std::uint8_t>(x * scale); };
    return {byte(c.r), byte(c.g), byte(c.b), static_cast<std::uint8_t>(exponent + 128)};
}

} // namespace

void write_png(const std::filesystem::path& path, const Image<Rgb8>& image) {
    Bytes rows;
    for (int y = 0; y < image.height(); ++y) {
        rows.push_back(2); // filter type "Up": each byte minus the one above it
        for (int x = 0; x < image.width(); ++x) {
            const Rgb8 here = image(x, y), above = y > 0 ? image(x, y - 1) : Rgb8{};
            for (const auto channel : {&Rgb8::r, &Rgb8::g, &Rgb8::b})
                rows.push_back(static_cast<std::uint8_t>((here.*channel - above.*channel) & 0xff));
        }
    }
    Bytes header;
    append_big_endian(header, static_cast<std::uint32_t>(image.width()));
    append_big_endian(header, static_cast<std::uint32_t>(image.height()));
    header.insert(header.end(), {8, 2, 0, 0, 0}); // 8 bits, RGB, no interlace
    Bytes stream{0x78, 0x01}; // zlib's header (RFC 1950)
    deflate(rows, stream);
    append_big_endian(stream, adler32(rows));

    Bytes file{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    append_chunk(file, "IHDR", header);
    append_chunk(file, "sRGB", {0});
    append_chunk(file, "IDAT", stream);
    append_chunk(file, "IEND", {});
    write_bytes(path, file);
}

void write_hdr(const std::filesystem::path& path, const ImageRgb& image) {
    const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(image.height()) + " +X " +
                               std::to_string(image.width()) + "\n";
    Bytes file(header.begin(), header.end());
    for (int y = 0; y < image.height(); ++y) {
        for (const int byte : {2, 2, image.width() >> 8, image.width() & 0xff})
            file.push_back(static_cast<std::uint8_t>(byte));
        // A row stores its four components one after the other, in runs. All runs here are literal, of at most 128
        // bytes.
        for (std::size_t component = 0; component < 4; ++component) {
            for (int x = 0; x < image.width(); ++x) {
                if (x % 128 == 0) file.push_back(static_cast<std::uint8_t>(std::min(128, image.width() - x)));
                file.push_back(rgbe(image(x, y))[component]);
            }
        }
    }
    write_bytes(path, file);
}

} // namespace duet::models
