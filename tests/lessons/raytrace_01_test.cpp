// Lesson raytrace-01: the library's vectors have the values that were computed by hand, and its files are the lesson's.
#include "common/image/image_file.h"
#include "common/image/srgb.h"
#include "tests/support/scratch.h"

#include <doctest/doctest.h>

#include <filesystem>

using namespace duet;

TEST_SUITE("lesson") {

    TEST_CASE("raytrace-01: vector operations have the values that were computed by hand") {
        const Vec3 a{1, 2, 3}, b{4, -5, 6};
        CHECK(a + b == Vec3{5, -3, 9});
        CHECK(a - b == Vec3{-3, 7, -3});
        CHECK(a * 2.0f == Vec3{2, 4, 6});
        CHECK(dot(a, b) == 12);                                      // 4 - 10 + 18
        CHECK(cross(a, b) == Vec3{27, 6, -13});                      // (12 + 15, 12 - 6, -5 - 8)
        CHECK(cross(b, a) == Vec3{-27, -6, 13});                     // the order matters
        CHECK(cross(Vec3{1, 0, 0}, Vec3{0, 1, 0}) == Vec3{0, 0, 1}); // right-handed
        CHECK(dot(cross(a, b), a) == 0);                             // 27 + 12 - 39
        CHECK(dot(cross(a, b), b) == 0);                             // 108 - 30 - 78
        CHECK(length_squared(cross(a, b)) == 14 * 77 - 12 * 12);     // |a|²|b|² - (a·b)² = 934
        CHECK(length(Vec3{2, 3, 6}) == 7);
        CHECK(normalize(Vec3{3, 4, 0}) == Vec3{0.6f, 0.8f, 0});
        CHECK(lerp(a, Vec3{5, -2, 3}, 0.25f) == Vec3{2, 1, 3});
    }

    TEST_CASE("raytrace-01: both kinds of PPM hold the bytes that the curve gives, and read back alike") {
        // sRGB: 0.5 is 188 (0.7354·255 = 187.52), 0.0031308 the end of the straight part, 0.25 is 137 (0.5371·255 =
        // 136.96).
        CHECK(srgb_encode_8bit(0.5f) == 188);
        CHECK(srgb_encode_8bit(0.25f) == 137);
        CHECK(srgb_encode_8bit(1.6f) == 255);
        CHECK(srgb_encode_8bit(-1) == 0);
        ImageRgb image(3, 2);
        for (std::size_t i = 0; i < image.size(); ++i) image[i] = Rgb(0.5f, 0.25f, static_cast<float>(i) / 5);
        const test::ScratchFolder folder;
        const auto text = folder / "p3.ppm", binary = folder / "p6.ppm";
        write_image(text, image, {.ascii_ppm = true});
        write_image(binary, image);
        CHECK(std::filesystem::file_size(binary) ==
              11 + 3 * image.size()); // "P6\n3 2\n255\n" and a byte for each number
        CHECK(read_image(text).pixels() == read_image(binary).pixels());
        for (std::size_t i = 0; i < image.size(); ++i)
            CHECK(read_image(text)[i] ==
                  Rgb(srgb_decode_8bit(188), srgb_decode_8bit(137), srgb_decode_8bit(srgb_encode_8bit(image[i].b))));
    }
}
