// This file reads and writes PPM (netpbm's ppm(5): P3, P6) and PFM (Debevec's portable float map: PF, Pf).
#include "common/image/formats.h"

#include <bit>
#include <charconv>
#include <cmath>

namespace duet {

namespace {

// Reads the words of a header and the numbers of a P3 file. A `#` starts a comment, which extends to the end of its
// line.
class TokenReader {
public:
    explicit TokenReader(const ImageBytes& file) : file_(file) {}

    std::size_t position() const { return at_; }

    std::string_view next(const char* expected) {
        skip_blanks();
        const std::size_t first = at_;
        while (at_ < file_.bytes.size() && !is_blank(file_.bytes[at_]) && at_ - first < 64) ++at_;
        if (first == at_) throw Error(message(file_.name, ": truncated: the file ends, expected ", expected));
        return file_.bytes.substr(first, at_ - first);
    }
    long long integer(const char* expected) { return number<long long>(expected); }
    double real(const char* expected) { return number<double>(expected); }

    // Skips the single blank that ends the header and returns the offset of the first pixel.
    std::size_t end_of_header() {
        if (at_ >= file_.bytes.size() || !is_blank(file_.bytes[at_]))
            throw Error(message(file_.name, ": truncated: the file ends within its header"));
        return ++at_;
    }

private:
    static bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

    void skip_blanks() {
        bool comment = false;
        for (; at_ < file_.bytes.size(); ++at_) {
            const char c = file_.bytes[at_];
            if (c == '#') comment = true;
            if (c == '\n' || c == '\r') comment = false;
            if (!comment && !is_blank(c)) return;
        }
    }

    template <typename Number> Number number(const char* expected) {
        const std::string_view word = next(expected);
        Number value{};
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (error != std::errc{} || end != word.data() + word.size())
            throw Error(message(file_.name, ": byte ", at_ - word.size(), ": found \"", printable(word),
                                "\", expected ", expected));
        return value;
    }

    static std::string printable(std::string_view word) {
        std::string text(word);
        for (char& c : text)
            if (c < ' ' || c > '~') c = '?';
        return text;
    }

    const ImageBytes& file_;
    std::size_t at_ = 2; // offset of the next byte to read; starts after the signature
};

[[noreturn]] void value_too_large(const ImageBytes& file, long long value, long long largest) {
    throw Error(message(file.name, ": a value of ", value, ", expected 0 to ", largest));
}

void read_ascii_values(const ImageBytes& file, TokenReader& tokens, long long largest, std::vector<float>& values) {
    for (float& value : values) {
        const long long stored = tokens.integer("a pixel's value");
        if (stored < 0 || stored > largest) value_too_large(file, stored, largest);
        value = static_cast<float>(stored) / static_cast<float>(largest);
    }
}

// Reads values of one byte, or of two bytes with the higher byte first if the largest value is above 255.
void read_binary_values(const ImageBytes& file, std::size_t at, long long largest, std::vector<float>& values) {
    const std::size_t size = largest > 255 ? 2 : 1;
    for (float& value : values) {
        const unsigned stored =
            size == 1 ? byte_at(file.bytes, at) : byte_at(file.bytes, at) << 8 | byte_at(file.bytes, at + 1);
        if (stored > largest) value_too_large(file, stored, largest);
        value = static_cast<float>(stored) / static_cast<float>(largest);
        at += size;
    }
}

StoredImage read_size(const ImageBytes& file, TokenReader& tokens, int channels, StoredImage::Encoding encoding) {
    const long long width = tokens.integer("the width"), height = tokens.integer("the height");
    check_image_size(file.name, width, height);
    return {static_cast<int>(width), static_cast<int>(height), channels, encoding, {}};
}

} // namespace

StoredImage decode_ppm(const ImageBytes& file) {
    TokenReader tokens(file);
    StoredImage image = read_size(file, tokens, 3, StoredImage::Encoding::kEncoded);
    const long long largest = tokens.integer("the largest value");
    if (largest < 1 || largest > 65535)
        throw Error(message(file.name, ": a largest value of ", largest, ", expected 1 to 65535"));
    const std::size_t first = tokens.end_of_header(), count = image.value_count();
    const bool ascii = file.bytes[1] == '3';
    // Each number of a P3 file takes at least one digit and one blank, but the last number needs no blank.
    const std::size_t bytes = ascii ? 2 * count - 1 : largest > 255 ? 2 * count : count;
    check_pixel_data_size(file, image.width, image.height, static_cast<double>(bytes),
                          static_cast<double>(file.bytes.size() - first));
    image.values.resize(count);
    if (ascii)
        read_ascii_values(file, tokens, largest, image.values);
    else
        read_binary_values(file, first, largest, image.values);
    return image;
}

StoredImage decode_pfm(const ImageBytes& file) {
    TokenReader tokens(file);
    StoredImage image = read_size(file, tokens, file.bytes[1] == 'F' ? 3 : 1, StoredImage::Encoding::kLinear);
    // The sign of the scale gives the byte order (negative: little endian). Its magnitude is the unit of the values.
    const double scale = tokens.real("the scale");
    if (!std::isfinite(scale) || scale == 0)
        throw Error(message(file.name, ": a scale of ", scale, ", expected a number but 0"));
    const std::size_t first = tokens.end_of_header(), count = image.value_count();
    check_pixel_data_size(file, image.width, image.height, 4.0 * static_cast<double>(count),
                          static_cast<double>(file.bytes.size() - first));
    image.values.resize(count);
    const bool little_endian = scale < 0;
    const auto unit = static_cast<float>(std::abs(scale));
    const std::size_t row = count / static_cast<std::size_t>(image.height);
    for (std::size_t i = 0; i < count; ++i) {
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 4; ++k)
            bits = bits << 8 | byte_at(file.bytes, first + 4 * i + (little_endian ? 3 - k : k));
        const float value = std::bit_cast<float>(bits);
        // PFM stores rows from the bottom.
        image.values[count - (i / row + 1) * row + i % row] = unit == 1 ? value : unit * value;
    }
    return image;
}

std::string encode_ppm(const ImageRgb& image, const WriteOptions& options) {
    const std::vector<std::uint8_t> bytes = display_bytes(image, options.view);
    std::string file = message(options.ascii_ppm ? "P3\n" : "P6\n", image.width(), ' ', image.height(), "\n255\n");
    if (!options.ascii_ppm) {
        file.append(bytes.begin(), bytes.end());
        return file;
    }
    // Write one pixel per line, which stays within the limit of 70 characters per line of ppm(5).
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        file += std::to_string(bytes[i]);
        file += i % 3 == 2 ? '\n' : ' ';
    }
    return file;
}

std::string encode_pfm(const ImageRgb& image, const WriteOptions&) {
    std::string file = message("PF\n", image.width(), ' ', image.height(), "\n-1.0\n");
    file.reserve(file.size() + 12 * image.size());
    for (int y = image.height() - 1; y >= 0; --y)
        for (int x = 0; x < image.width(); ++x)
            for (std::size_t c = 0; c < 3; ++c) {
                const auto bits = std::bit_cast<std::uint32_t>(image(x, y)[c]);
                for (unsigned shift = 0; shift < 32; shift += 8) file += static_cast<char>(bits >> shift & 255u);
            }
    return file;
}

} // namespace duet
