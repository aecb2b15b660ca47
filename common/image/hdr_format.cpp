// This file implements Radiance's HDR format. A pixel consists of three 8-bit fractions and a shared exponent; the
// pixels are run-length encoded (Ward, "Real Pixels", Graphics Gems II, 1991; the file format is described in
// radsite.lbl.gov/radiance/refer/filefmts.pdf, "Image File Format").
//
// The project does not use stb for this format: stb_image 2.27 never returns from a truncated run, and stb_image_write
// truncates the fractions instead of rounding them, which darkens an image by 0.3 % on average.
#include "common/image/formats.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace duet {

namespace {

using Rgbe = std::array<std::uint8_t, 4>;

constexpr std::size_t kMinRunWidth = 8, kMaxRunWidth = 32767;

// Converts a color to RGBE. Fractions are rounded to the nearest multiple of 1/256, so the error is at most 1/256 of
// the largest channel. Negative values and NaN become 0, and values that are too large become the largest value.
Rgbe to_rgbe(Rgb color) {
    constexpr float kLargest = 0x1.fep126f; // (255/256)·2^127
    std::array<float, 3> c{};
    for (std::size_t k = 0; k < 3; ++k) c[k] = color[k] > 0 ? std::min(color[k], kLargest) : 0.0f;
    const float largest = std::max({c[0], c[1], c[2]});
    int exponent = 0;
    const float fraction = std::frexp(largest, &exponent);
    if (fraction >= 255.5f / 256) ++exponent; // rounds up to the next power of two
    if (largest == 0 || exponent < -127) return {0, 0, 0, 0};
    Rgbe rgbe{};
    for (std::size_t k = 0; k < 3; ++k)
        rgbe[k] = static_cast<std::uint8_t>(std::lround(std::ldexp(c[k], 8 - exponent)));
    rgbe[3] = static_cast<std::uint8_t>(exponent + 128);
    return rgbe;
}

void append_values(const Rgbe& rgbe, std::vector<float>& values) {
    const float unit = rgbe[3] == 0 ? 0.0f : std::ldexp(1.0f, rgbe[3] - (128 + 8));
    for (std::size_t k = 0; k < 3; ++k) values.push_back(unit * static_cast<float>(rgbe[k]));
}

class HdrReader {
public:
    explicit HdrReader(const ImageBytes& file) : file_(file) {}

    StoredImage read() {
        read_header();
        StoredImage image = read_size();
        const auto width = static_cast<std::size_t>(image.width), height = static_cast<std::size_t>(image.height);
        check_pixel_data_size(file_, image.width, image.height, min_bytes(width, height),
                              static_cast<double>(file_.bytes.size() - at_));
        image.values.reserve(3 * width * height);
        std::vector<Rgbe> scanline(width);
        for (std::size_t y = 0; y < height; ++y) {
            if (is_run_length_encoded(width))
                read_run_length_encoded(scanline);
            else
                read_flat(scanline);
            for (const Rgbe& pixel : scanline) append_values(pixel, image.values);
        }
        return image;
    }

private:
    [[noreturn]] void fail(const std::string& what) const { throw Error(message(file_.name, ": ", what)); }

    std::uint8_t byte() {
        if (at_ >= file_.bytes.size()) fail("truncated: the file ends within the pixels");
        return static_cast<std::uint8_t>(file_.bytes[at_++]);
    }

    std::string_view line() {
        const std::size_t end = file_.bytes.find('\n', at_);
        if (end == std::string_view::npos) fail("truncated: the file ends within its header");
        const std::string_view text = file_.bytes.substr(at_, end - at_);
        at_ = end + 1;
        return text;
    }

    // Reads the header lines up to an empty line. Only the variable FORMAT matters; exposures apply to display only.
    void read_header() {
        bool is_rgbe = false;
        while (true) {
            const std::string_view text = line();
            if (text.empty()) break;
            if (text.starts_with("FORMAT=")) {
                if (text != "FORMAT=32-bit_rle_rgbe") fail("a format other than 32-bit_rle_rgbe");
                is_rgbe = true;
            }
        }
        if (!is_rgbe) fail("no line FORMAT=32-bit_rle_rgbe in its header");
    }

    StoredImage read_size() {
        const std::string_view text = line();
        const char *at = text.data(), *end = at + text.size();
        const auto side = [&](std::string_view axis) {
            int length = 0;
            if (!std::string_view(at, static_cast<std::size_t>(end - at)).starts_with(axis))
                fail("a resolution line other than \"-Y height +X width\"");
            const auto [next, error] = std::from_chars(at + axis.size(), end, length);
            if (error != std::errc{}) fail("no size in its resolution line");
            at = next;
            return length;
        };
        const int height = side("-Y "), width = side(" +X ");
        check_image_size(file_.name, width, height);
        return {width, height, 3, StoredImage::Encoding::kLinear, {}};
    }

    // Returns the smallest number of bytes that can store all scanlines. A run of up to 127 equal values takes two
    // bytes per channel. In flat scanlines, one repeat pixel can represent 255 and more pixels.
    static double min_bytes(std::size_t width, std::size_t height) {
        const double run_coded = 4.0 + 8.0 * std::ceil(static_cast<double>(width) / 127.0);
        const double repeated = 4.0 + 4.0 * std::floor(static_cast<double>(width) / 65536.0);
        return static_cast<double>(height) * std::min(run_coded, repeated);
    }

    bool is_run_length_encoded(std::size_t width) const {
        if (width < kMinRunWidth || width > kMaxRunWidth || file_.bytes.size() - at_ < 4) return false;
        const auto at = [&](std::size_t i) { return static_cast<std::uint8_t>(file_.bytes[at_ + i]); };
        return at(0) == 2 && at(1) == 2 && at(2) < 128;
    }

    // Reads one channel after another. Each consists of runs of equal values (128 + count, value) and of runs of
    // different values (count, values …).
    void read_run_length_encoded(std::vector<Rgbe>& scanline) {
        at_ += 2;
        const unsigned high = byte(), low = byte();
        if ((high << 8 | low) != scanline.size()) fail("corrupt: a scanline of another length than the image's width");
        for (std::size_t channel = 0; channel < 4; ++channel)
            for (std::size_t x = 0; x < scanline.size();) {
                const std::uint8_t code = byte();
                const bool equal = code > 128;
                const std::size_t count = equal ? code - 128u : code;
                if (count == 0 || count > scanline.size() - x) fail("corrupt: a run goes beyond its scanline");
                std::uint8_t value = equal ? byte() : std::uint8_t{0};
                for (std::size_t i = 0; i < count; ++i) {
                    if (!equal) value = byte();
                    scanline[x++][channel] = value;
                }
            }
    }

    // Reads one pixel after another. A pixel (1, 1, 1, n) repeats the previous pixel n times. If repeat pixels follow
    // each other directly, the k-th of them (from 0) counts n·256ᵏ pixels.
    void read_flat(std::vector<Rgbe>& scanline) {
        unsigned shift = 0;
        for (std::size_t x = 0; x < scanline.size();) {
            Rgbe pixel{};
            for (std::uint8_t& component : pixel) component = byte();
            if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
                scanline[x++] = pixel;
                shift = 0;
                continue;
            }
            const std::size_t count = static_cast<std::size_t>(pixel[3]) << shift;
            if (x == 0 || shift > 16 || count > scanline.size() - x) fail("corrupt: a run goes beyond its scanline");
            std::fill_n(scanline.begin() + static_cast<std::ptrdiff_t>(x), count, scanline[x - 1]);
            x += count;
            shift += 8;
        }
    }

    const ImageBytes& file_;
    std::size_t at_ = 0;
};

// Appends one channel of a scanline in runs. Equal values form a run of their own only if there are at least 4, because
// a shorter run saves no bytes.
void append_runs(const std::vector<Rgbe>& scanline, std::size_t channel, std::string& file) {
    const auto equal_from = [&](std::size_t x) {
        std::size_t end = x + 1;
        while (end < scanline.size() && end - x < 127 && scanline[end][channel] == scanline[x][channel]) ++end;
        return end - x;
    };
    for (std::size_t x = 0; x < scanline.size();) {
        std::size_t count = equal_from(x);
        if (count >= 4) {
            file += static_cast<char>(128 + count);
            file += static_cast<char>(scanline[x][channel]);
            x += count;
            continue;
        }
        const std::size_t first = x;
        while (x < scanline.size() && x - first < 128 && (count = equal_from(x)) < 4)
            x += std::min(count, 128 - (x - first));
        file += static_cast<char>(x - first);
        for (std::size_t i = first; i < x; ++i) file += static_cast<char>(scanline[i][channel]);
    }
}

} // namespace

StoredImage decode_hdr(const ImageBytes& file) { return HdrReader(file).read(); }

std::string encode_hdr(const ImageRgb& image, const WriteOptions&) {
    std::string file =
        message("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y ", image.height(), " +X ", image.width(), '\n');
    const auto width = static_cast<std::size_t>(image.width());
    const bool runs = width >= kMinRunWidth && width <= kMaxRunWidth;
    std::vector<Rgbe> scanline(width);
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) scanline[static_cast<std::size_t>(x)] = to_rgbe(image(x, y));
        if (runs) {
            for (const std::size_t component : {std::size_t{2}, std::size_t{2}, width >> 8, width & 255})
                file += static_cast<char>(component);
            for (std::size_t channel = 0; channel < 4; ++channel) append_runs(scanline, channel, file);
        } else {
            for (const Rgbe& pixel : scanline) file.append(pixel.begin(), pixel.end());
        }
    }
    return file;
}

} // namespace duet
