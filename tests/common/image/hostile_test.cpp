// These tests read files that have false headers, are truncated, or are not images. Each must give one Error before
// memory is allocated for data that is missing.
#include "common/image/image_file.h"
#include "common/image/srgb.h"
#include "tests/common/image/image_bytes.h"

#include <doctest/doctest.h>

#include <random>

using namespace duet;
using namespace duet::test;

namespace {

ImageRgb some_image() {
    std::mt19937 random(5);
    ImageRgb image(61, 40);
    for (std::size_t i = 0; i < image.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c) image[i][c] = srgb_decode_8bit(static_cast<std::uint8_t>(random() & 255u));
    return image;
}

constexpr const char* kEndings[] = {"png", "jpg", "tga", "ppm", "pfm", "hdr", "exr"};

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("what is no file, and files that are no image") {
        const test::ScratchFolder folder;
        CHECK(error_of([&] { read_image(folder / "none.png"); }) == Containing("none.png: no such file"));
        CHECK(error_of([&] { read_image(folder.path()); }) == Containing("not a regular file"));
        CHECK(error_of([&] { read_exr(folder.path()); }) == Containing("not a regular file"));
        CHECK(error_of_bytes(folder / "empty.png", "") == Containing("empty file"));
        CHECK(error_of_bytes(folder / "empty.tga", "") == Containing("empty file"));
        CHECK(error_of_bytes(folder / "text.png", "hello, world\n") == Containing("unknown format, expected a PNG"));
        CHECK(error_of_bytes(folder / "gif.png", "GIF89a\1\0\1\0") == Containing("unknown format"));
        CHECK(error_of_bytes(folder / "text.tga", "hello, world\n") == Containing("TGA"));
        CHECK(error_of([&] { read_exr(folder / "text.png"); }) == Containing("not an EXR"));
    }

    TEST_CASE("a file cut off anywhere is an Error") {
        const test::ScratchFolder folder;
        for (const char* ending : kEndings) {
            CAPTURE(ending);
            const auto path = folder / message("a.", ending);
            write_image(path, some_image());
            const std::string bytes = read_file(path);
            std::vector<std::size_t> sizes{bytes.size() - 1, bytes.size() - 2, bytes.size() - 3};
            for (std::size_t i = 1; i < 60; ++i) sizes.push_back(i * bytes.size() / 60);
            for (std::size_t i = 1; i < 30 && i < bytes.size(); ++i) sizes.push_back(i);
            for (const std::size_t size : sizes) {
                CAPTURE(size);
                // A TGA that ends within its run-length data is rejected. A TGA that is cut within its footer has
                // lost no pixel.
                CHECK(error_of_bytes(path, bytes.substr(0, size)) != "no error");
            }
        }
    }

    TEST_CASE("changed bytes never crash the readers") {
        const test::ScratchFolder folder;
        std::mt19937 random(11);
        for (const char* ending : kEndings) {
            CAPTURE(ending);
            const auto path = folder / message("a.", ending);
            write_image(path, some_image());
            const std::string bytes = read_file(path);
            for (int trial = 0; trial < 150; ++trial) {
                std::string changed = bytes;
                const std::size_t reach = trial % 2 == 0 ? 400 : changed.size(); // changes hit the header more often
                for (int i = 0; i <= trial % 4; ++i)
                    changed[random() % std::min(reach, changed.size())] = static_cast<char>(random() & 255u);
                const std::string error = error_of_bytes(path, changed);
                // PNG checksums cover every byte.
                if (std::string(ending) == "png" && changed != bytes) CHECK(error != "no error");
            }
        }
    }

    TEST_CASE("PNG: sizes that cannot be") {
        const test::ScratchFolder folder;
        const std::string claim = error_of_bytes(folder / "claim.png", png(100000, 100000, 8, 2, "abc"));
        CHECK(claim == Containing("an image of 100000 x 100000 pixels, expected 1 to 32768 a side"));
        CHECK(error_of_bytes(folder / "a.png", png(30000, 30000, 8, 2, "abc")) ==
              Containing("at most 90000000 in all"));
        CHECK(error_of_bytes(folder / "b.png", png(30000, 3000, 8, 2, "abc")) == Containing("cannot be in its"));
        CHECK(error_of_bytes(folder / "c.png", png(0, 1, 8, 2, "abc")) == Containing("an image of 0 x 1"));
        CHECK(error_of_bytes(folder / "d.png", png(2, 2, 8, 2, std::string(7, '\0'))) ==
              Containing("not a readable PNG"));
        CHECK(error_of_bytes(folder / "e.png", kPngSignature) == Containing("truncated"));
        CHECK(error_of_bytes(folder / "f.png", kPngSignature + png_chunk("IEND")) == Containing("header (IHDR)"));
        CHECK(error_of_bytes(folder / "g.png", kPngSignature + big_endian(0xfffffff0u) + "IHDR    ") ==
              Containing("truncated"));
    }

    TEST_CASE("PNG: 16 bits are read with 16 bits; gray and alpha") {
        const test::ScratchFolder folder;
        // The file has two gray pixels of 16 bits: 0x1234 and 0xffff.
        write_file(folder / "grey.png", png(2, 1, 16, 0, std::string("\0\x12\x34\xff\xff", 5)));
        const StoredImage grey = read_stored_image(folder / "grey.png");
        CHECK(grey.channels == 1);
        CHECK(grey.encoding == StoredImage::Encoding::kEncoded);
        CHECK(grey.values == std::vector{0x1234 / 65535.0f, 1.0f});
        CHECK(to_linear(grey)[0].g == srgb_decode(0x1234 / 65535.0f));
        write_file(folder / "rgba.png", png(1, 1, 8, 6, std::string("\0\x33\x66\xff\x80", 5)));
        const StoredImage rgba = read_stored_image(folder / "rgba.png");
        CHECK(rgba.values == std::vector{0x33 / 255.0f, 0x66 / 255.0f, 1.0f, 0x80 / 255.0f});
    }

    TEST_CASE("JPEG: a size out of proportion to the file") {
        const test::ScratchFolder folder;
        write_image(folder / "a.jpg", some_image());
        const std::string bytes = read_file(folder / "a.jpg");
        const std::size_t frame = bytes.find("\xff\xc0");
        REQUIRE(frame != std::string::npos);
        const auto claim = [&](unsigned width, unsigned height) {
            std::string changed = bytes;
            const unsigned parts[] = {height >> 8, height & 255u, width >> 8, width & 255u};
            for (std::size_t i = 0; i < 4; ++i) changed[frame + 5 + i] = static_cast<char>(parts[i]);
            return error_of_bytes(folder / "claim.jpg", changed);
        };
        CHECK(claim(65500, 65500) == Containing("an image of 65500 x 65500"));
        CHECK(claim(30000, 30000) == Containing("at most 90000000 in all"));
        CHECK(claim(30000, 3000) == Containing("cannot be in its"));
        CHECK(claim(0, 40) == Containing("an image of 0 x 40"));
        CHECK(error_of_bytes(folder / "short.jpg", bytes.substr(0, frame + 6)) == Containing("truncated"));
    }

    TEST_CASE("JPEG: segments that are not whole, and tables that would not fit") {
        const test::ScratchFolder folder;
        write_image(folder / "a.jpg", some_image());
        const std::string bytes = read_file(folder / "a.jpg");
        const auto error = [&](const std::string& changed) { return error_of_bytes(folder / "b.jpg", changed); };
        const std::size_t table = bytes.find("\xff\xc4"), frame = bytes.find("\xff\xc0");
        REQUIRE(table != std::string::npos);
        // Fuzzing found this case: stb writes beyond its table.
        CHECK(error(std::string(bytes).replace(table + 5, 16, std::string(16, '\xff'))) ==
              Containing("a Huffman table of 4080 codes"));
        CHECK(error(std::string(bytes).replace(table + 2, 2, std::string(2, '\0'))) ==
              Containing("a segment of 0 bytes"));
        CHECK(error(std::string(bytes).replace(table + 2, 2, "\xff\xff")) == Containing("truncated"));
        CHECK(error(bytes.substr(0, bytes.size() - 2)) == Containing("before its end marker (EOI)"));
        CHECK(error(bytes.substr(0, frame) + "\xff\xd9") == Containing("before its frame (SOF)"));
        // The file has no tables or no scan. Any result is accepted, but it must be the same each time.
        const std::size_t scan = bytes.find("\xff\xda");
        for (const std::string& part :
             {bytes.substr(0, table) + bytes.substr(scan), bytes.substr(0, scan) + "\xff\xd9"}) {
            write_file(folder / "c.jpg", part);
            std::vector<float> first;
            for (int i = 0; i < 3; ++i) {
                const std::vector<char> dirt(100000, static_cast<char>(i + 65));
                std::vector<float> values;
                try {
                    values = read_stored_image(folder / "c.jpg").values;
                } catch (const Error&) {
                }
                if (i == 0) first = values;
                CHECK(values == first);
            }
        }
    }

    TEST_CASE("TGA: sizes beyond the file") {
        const test::ScratchFolder folder;
        CHECK(error_of_bytes(folder / "a.tga", tga(2, 30000, 3000, 24, "abc")) == Containing("cannot be in its"));
        CHECK(error_of_bytes(folder / "b.tga", tga(10, 30000, 3000, 24, "abc")) == Containing("cannot be in its"));
        CHECK(error_of_bytes(folder / "c.tga", tga(2, 65535, 65535, 24, "abc")) ==
              Containing("an image of 65535 x 65535"));
        CHECK(error_of_bytes(folder / "d.tga", tga(2, 2, 2, 24, std::string(11, 'a'))) ==
              Containing("cannot be in its"));
        CHECK(error_of_bytes(folder / "e.tga", tga(10, 2, 2, 24, std::string("\1abcdef\1abc", 11))) ==
              Containing("truncated"));
        CHECK(error_of_bytes(folder / "f.tga", tga(2, 2, 2, 24, std::string(12, 'a'))) == "no error");
        CHECK(error_of_bytes(folder / "g.tga", tga(10, 2, 2, 24, std::string("\1abcdef\1abcdef", 14))) == "no error");
        // Fuzzing found this case: 0xff is allowed before the start of a JPEG, and it made stb decode the JPEG as a
        // TGA.
        write_image(folder / "a.jpg", some_image());
        CHECK(error_of_bytes(folder / "i.tga", message('\xff', read_file(folder / "a.jpg"))) ==
              Containing("no TGA header"));
        // The color map extends beyond the end of the file.
        std::string mapped = tga(1, 2, 2, 8, std::string(4, '\0'));
        mapped[1] = 1;
        mapped[5] = static_cast<char>(255);
        mapped[7] = 24;
        CHECK(error_of_bytes(folder / "h.tga", mapped) == Containing("TGA"));
    }

    TEST_CASE("HDR: sizes, formats and runs that cannot be") {
        const test::ScratchFolder folder;
        const auto error = [&](const std::string& bytes) { return error_of_bytes(folder / "a.hdr", bytes); };
        CHECK(error(hdr("-Y 100000 +X 100000", "")) == Containing("an image of 100000 x 100000"));
        CHECK(error(hdr("-Y 3000 +X 30000", "abcd")) == Containing("cannot be in its"));
        CHECK(error(hdr("-Y -5 +X 5", "abcd")) == Containing("an image of 5 x -5"));
        CHECK(error(hdr("-Y 99999999999999 +X 5", "abcd")) == Containing("no size"));
        CHECK(error(hdr("+Y 5 +X 5", "abcd")) == Containing("-Y height +X width"));
        CHECK(error("#?RADIANCE\n\n-Y 1 +X 1\nabcd") == Containing("no line FORMAT"));
        CHECK(error("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\nabcd") == Containing("other than"));
        CHECK(error("#?RADIANCE\nFORMAT=32-bit_rle_rgbe") == Containing("within its header"));
        CHECK(error(hdr("-Y 1 +X 2", "abcd")) == Containing("truncated"));
        const std::string start("\2\2\0\x08", 4), run("\x88"
                                                      "a");
        CHECK(error(hdr("-Y 1 +X 8", start + run + run + run + run)) == "no error");
        CHECK(error(hdr("-Y 1 +X 8", start + run + run + run + "\x88")) == Containing("truncated"));
        CHECK(error(hdr("-Y 1 +X 8", start + run + run + run +
                                         "\x89"
                                         "a")) == Containing("beyond its scanline"));
        // The run has length zero: stb_image 2.27 never returns from it.
        CHECK(error(hdr("-Y 1 +X 8", start + run + run + run + std::string("\0\0", 2))) ==
              Containing("beyond its scanline"));
        CHECK(error(hdr("-Y 1 +X 9", start + run + run + run + run)) == Containing("another length"));
        // The old run-length encoding is a pixel followed by (1, 1, 1, count).
        CHECK(error(hdr("-Y 1 +X 300", std::string("\x80\1\2\x81\1\1\1\x2b\1\1\1\1", 12))) == "no error");
        CHECK(read_stored_image(folder / "a.hdr").values[3 * 299] == 1.0f);
        CHECK(error(hdr("-Y 1 +X 300", std::string("\x80\1\2\x81\1\1\1\xff\1\1\1\1", 12))) ==
              Containing("beyond its scanline"));
        CHECK(error(hdr("-Y 1 +X 4", std::string("\1\1\1\2\x80\1\2\x81", 8))) == Containing("beyond its scanline"));
    }

    TEST_CASE("PPM and PFM: headers") {
        const test::ScratchFolder folder;
        const auto error = [&](const std::string& bytes) { return error_of_bytes(folder / "a.ppm", bytes); };
        const auto values = [&](const std::string& bytes) {
            write_file(folder / "a.ppm", bytes);
            return read_stored_image(folder / "a.ppm").values;
        };
        CHECK(values("P3 # a comment\n#another\n 1 # width\n1\t255\r\n255 0\n51") == std::vector{1.0f, 0.0f, 0.2f});
        CHECK(values("P3 1 1 1023 1023 0 341 # end") == std::vector{1.0f, 0.0f, 341 / 1023.0f});
        CHECK(values("P6#c\n1 1 255\n\xff\x20#") == std::vector{1.0f, 0x20 / 255.0f, '#' / 255.0f});
        CHECK(values(std::string("P6 1 1 65535 \x12\x34\xff\xff\0\0", 19)) ==
              std::vector{0x1234 / 65535.0f, 1.0f, 0.0f});
        CHECK(values("P6 1 1 100 dd\1") == std::vector{1.0f, 1.0f, 0.01f});

        CHECK(error("P6 100000 100000 255 abc") == Containing("an image of 100000 x 100000"));
        CHECK(error("P6 9999 9000 255 abc") == Containing("cannot be in its"));
        CHECK(error("P3 9999 9000 255 1 2 3") == Containing("cannot be in its"));
        CHECK(error("P6 99999999999999999999 1 255 abc") == Containing("expected the width"));
        CHECK(error("P6 -1 1 255 abc") == Containing("an image of -1 x 1"));
        CHECK(error("P6 1 1 65536 abcabc") == Containing("expected 1 to 65535"));
        CHECK(error("P6 1 1 0 abcabc") == Containing("expected 1 to 65535"));
        CHECK(error("P6 1 1 99 ddd") == Containing("a value of 100, expected 0 to 99"));
        CHECK(error("P3 1 1 99 1 2 100") == Containing("a value of 100, expected 0 to 99"));
        CHECK(error("P3 1 1 99 1 2 -3") == Containing("a value of -3"));
        CHECK(error("P3 1 1 99 1 x 3") == Containing("found \"x\", expected a pixel's value"));
        CHECK(error("P3 2 1 99 1 2 3 44 5   ") == Containing("truncated: the file ends, expected a pixel's value"));
        CHECK(error("P3 2 1 99 1 2 3 44444") == Containing("a value of 44444"));
        CHECK(error("P6 1 1 255 ab") == Containing("cannot be in its"));
        CHECK(error("P6 1 1") == Containing("expected the largest value"));
        CHECK(error("P6 1 1 255") == Containing("within its header"));
        CHECK(error("P3 # no end") == Containing("expected the width"));
        CHECK(error("P5 1 1 255 a") == Containing("unknown format"));

        // The files cover both byte orders, gray, the scale factor, and rows stored from the bottom.
        CHECK(values(std::string("Pf\n1 2\n1\n\x3f\x80\0\0\x40\0\0\0", 17)) == std::vector{2.0f, 1.0f});
        CHECK(values(std::string("Pf\n1 2\n-1.0\n\0\0\x80\x3f\0\0\0\x40", 20)) == std::vector{2.0f, 1.0f});
        CHECK(values(std::string("PF\n1 1\n-2e0\n\0\0\x80\x3f\0\0\0\x40\0\0\0\0", 24)) ==
              std::vector{2.0f, 4.0f, 0.0f});
        CHECK(error("PF 100000 100000 -1 abcd") == Containing("an image of 100000 x 100000"));
        CHECK(error("PF 9999 9000 -1 abcd") == Containing("cannot be in its"));
        CHECK(error("PF 1 1 0 abcdabcdabcd") == Containing("a scale of 0"));
        CHECK(error("PF 1 1 nan abcdabcdabcd") == Containing("a scale of nan"));
        CHECK(error("PF 1 1 -1 abcdabcdabc") == Containing("cannot be in its"));
    }
}
