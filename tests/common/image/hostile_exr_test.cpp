// These tests read EXR files as other writers produce them, and files whose headers are false.
#include "common/image/image_file.h"
#include "tests/common/image/exr_bytes.h"
#include "tests/common/image/image_bytes.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::test;

TEST_SUITE("unit") {

    TEST_CASE("EXR: half floats, any data window, tiles") {
        const test::ScratchFolder folder;
        // The values are half floats: 0x3c00 is 1, and the exponent is in bits 10 to 14.
        const auto value = [](std::size_t c, int x, int y) {
            return (static_cast<unsigned>(x + 3 * y) + 10) << 10 | static_cast<unsigned>(c) << 8;
        };
        const auto expected = [](std::size_t c, int x, int y) {
            return std::ldexp(1.0f + static_cast<float>(c) / 4, x + 3 * y + 10 - 15);
        };
        ExrBytes flat, tiled;
        tiled.version |= 0x200;
        tiled.tile_width = 2;
        tiled.tile_height = 1;
        for (const ExrBytes& kind : {flat, tiled}) {
            write_file(folder / "a.exr", kind.build(value));
            const ImageRgb image = read_image(folder / "a.exr");
            const ExrFile file = read_exr(folder / "a.exr");
            REQUIRE(image.width() == 3);
            REQUIRE(image.height() == 2);
            REQUIRE(file.channels.size() == 3);
            for (int y = 0; y < 2; ++y)
                for (int x = 0; x < 3; ++x) {
                    CHECK(image(x, y) == Rgb(expected(2, x, y), expected(1, x, y), expected(0, x, y)));
                    CHECK(file.channels[0].floats[static_cast<std::size_t>(x + 3 * y)] == expected(0, x, y));
                }
        }
    }

    TEST_CASE("EXR: what is absurd or not read") {
        const test::ScratchFolder folder;
        const auto error = [&](auto change) {
            ExrBytes file;
            change(file);
            const std::string text = error_of_bytes(folder / "a.exr", file.header() + std::string(200000, '\0'));
            CHECK(error_of([&] { read_exr(folder / "a.exr"); }) != "no error");
            return text;
        };
        CHECK(error([](ExrBytes&) {}) == Containing("not a readable EXR"));
        CHECK(error([](ExrBytes& f) { f.max_x = f.max_y = 99999; }) ==
              Containing("pixels, expected 1 to 32768 a side"));
        CHECK(error([](ExrBytes& f) {
                  f.min_x = f.min_y = -2147483647;
                  f.max_x = f.max_y = 2147483647;
              }) == Containing("expected 1 to 32768"));
        CHECK(error([](ExrBytes& f) { f.max_x = -100; }) == Containing("expected 1 to 32768"));
        CHECK(error([](ExrBytes& f) {
                  f.max_x = 29999;
                  f.max_y = 2900;
                  f.compression = 3;
              }) == Containing("cannot be in its"));
        CHECK(error([](ExrBytes& f) {
                  f.max_x = 29999;
                  f.extra_channels = 3000;
                  f.compression = 3;
              }) == Containing("bytes a pixel"));
        CHECK(error([](ExrBytes& f) { f.sampling = 2; }) == Containing("subsampled"));
        CHECK(error([](ExrBytes& f) { f.type = 7; }) == Containing("EXR"));
        CHECK(error([](ExrBytes& f) { f.compression = 99; }) == Containing("EXR"));
        CHECK(error([](ExrBytes& f) { f.version |= 0x800; }) == Containing("deep"));
        CHECK(error([](ExrBytes& f) { f.version |= 0x1000; }) == Containing("several parts"));
        CHECK(error([](ExrBytes& f) {
                  f.version |= 0x200;
                  f.tile_width = f.tile_height = 0x7fffffff;
              }) == Containing("tiles of"));
        CHECK(error([](ExrBytes& f) { f.version |= 0x200; }) == Containing("EXR"));
        CHECK(error([](ExrBytes& f) {
                  f.channels = {"R", "Z"};
              }) == Containing("channels R Z, expected R, G and B, or Y"));
        CHECK(error([](ExrBytes& f) { f.channels = {}; }) == Containing("EXR"));
        CHECK(error_of_bytes(folder / "a.exr", "\x76\x2f\x31\x01") == Containing("ends early"));
        // Fuzzing found this case: OpenEXR allocates as many bytes as a text attribute claims.
        const auto attribute_error = [&](const char* type, std::int32_t size, const std::string& value) {
            Bytes attribute;
            attribute.add_text("note").add_text(type).add(size);
            return error_of_bytes(folder / "a.exr", ExrBytes().header().substr(0, 8) + attribute.text + value);
        };
        CHECK(attribute_error("string", 0x7fffffff, "text") == Containing("the EXR header ends early"));
        // OpenEXR reads an attribute by its type, so that a wrong size would hide what comes next from the check.
        const std::string one = std::string(4, '\0'), list = std::string("R\0", 2) + std::string(16, '\0');
        CHECK(attribute_error("int", 8, one + one) == Containing("another size for its type"));
        CHECK(attribute_error("chlist", 20, list + std::string(2, '\0')) == Containing("another size for its type"));
        CHECK(attribute_error("chlist", 18, list) == Containing("another size for its type"));
        CHECK(attribute_error("preview", 8, std::string(8, '\1')) == Containing("another size for its type"));
        CHECK(attribute_error("stringvector", 4, std::string("\1\0\0\0", 4)) == Containing("another size for its"));
    }
}
