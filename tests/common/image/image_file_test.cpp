// These tests write images and read them back. The bits must be equal where the format is lossless.
#include "common/image/bitwise_equal.h"
#include "common/image/image_file.h"
#include "common/image/srgb.h"
#include "tests/support/errors.h"
#include "tests/support/scratch.h"

#include <doctest/doctest.h>

#include <bit>
#include <limits>
#include <random>
#include <sys/resource.h>

#include <csignal>

using namespace duet;
using duet::test::Containing;
using duet::test::error_of;

namespace {

// The pixels have values of all magnitudes, a few of them special.
ImageRgb radiance_image(int width, int height) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> exponent(-20, 20), sign(-0.2f, 1);
    ImageRgb image(width, height);
    for (std::size_t i = 0; i < image.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c) image[i][c] = std::copysign(std::exp2(exponent(random)), sign(random));
    image[0] = {0.0f, -0.0f, std::numeric_limits<float>::denorm_min()};
    image[1] = {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::max(),
                std::bit_cast<float>(0x7fc00123u)};
    return image;
}

// Each pixel is the linear value of one of the 256 codes. The top left one is red, the top right green, the bottom
// left blue.
ImageRgb encoded_image(int width, int height) {
    std::mt19937 random(8);
    ImageRgb image(width, height);
    for (std::size_t i = 0; i < image.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c) image[i][c] = srgb_decode_8bit(static_cast<std::uint8_t>(random() & 255u));
    image(0, 0) = {1, 0, 0};
    image(width - 1, 0) = {0, 1, 0};
    image(0, height - 1) = {0, 0, 1};
    return image;
}

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("8-bit files keep each code: PNG, TGA, PPM in bytes and in text") {
        const test::ScratchFolder folder;
        for (const auto& size : {std::pair{37, 23}, {1, 1}, {300, 2}, {1, 129}}) {
            const ImageRgb image = encoded_image(size.first, size.second);
            for (const char* name : {"a.png", "a.tga", "a.ppm", "A.PNG"}) {
                CAPTURE(name);
                CAPTURE(size.first);
                write_image(folder / name, image);
                CHECK(bitwise_equal(read_image(folder / name), image));
            }
            write_image(folder / "text.ppm", image, {.ascii_ppm = true});
            CHECK(read_file(folder / "text.ppm").substr(0, 2) == "P3");
            CHECK(bitwise_equal(read_image(folder / "text.ppm"), image));
        }
    }

    TEST_CASE("8-bit files hold runs too") { // TGA run lengths and PNG matches
        const test::ScratchFolder folder;
        ImageRgb image = encoded_image(500, 9);
        for (int y = 0; y < 9; ++y)
            for (int x = 20; x < 480; ++x)
                if (x % 150 > 3) image(x, y) = image(20, y);
        for (const char* name : {"a.png", "a.tga"}) {
            write_image(folder / name, image);
            CHECK(bitwise_equal(read_image(folder / name), image));
        }
    }

    TEST_CASE("PFM and EXR keep every bit: infinity, NaN, negative zero") {
        const test::ScratchFolder folder;
        for (const auto& size : {std::pair{37, 23}, {2, 1}, {300, 40}}) {
            const ImageRgb image = radiance_image(size.first, size.second);
            for (const char* name : {"a.pfm", "a.exr"}) {
                CAPTURE(name);
                write_image(folder / name, image);
                CHECK(bitwise_equal(read_image(folder / name), image));
                const StoredImage file = read_stored_image(folder / name);
                CHECK(file.encoding == StoredImage::Encoding::kLinear);
                CHECK(file.channels == 3);
            }
        }
    }

    TEST_CASE("JPEG is near at quality 95 and coarser at 10") {
        const test::ScratchFolder folder;
        ImageRgb image(64, 48);
        for (int y = 0; y < 48; ++y)
            for (int x = 0; x < 64; ++x)
                image(x, y) = {srgb_decode(static_cast<float>(x) / 63), srgb_decode(static_cast<float>(y) / 47), 0.25f};
        const auto largest_error = [&](int quality) {
            write_image(folder / "a.jpg", image, {.jpeg_quality = quality});
            const ImageRgb again = read_image(folder / "a.jpg");
            float error = 0;
            for (std::size_t i = 0; i < image.size(); ++i)
                for (std::size_t c = 0; c < 3; ++c)
                    error = std::max(error, std::abs(srgb_encode(again[i][c]) - srgb_encode(image[i][c])));
            return error;
        };
        const float fine = largest_error(95), coarse = largest_error(10);
        CHECK(fine < 0.03f);
        CHECK(coarse > fine);
        CHECK(coarse < 0.3f);
    }

    TEST_CASE("HDR rounds to nearest: 1/256 of the largest channel at most, without bias") {
        const test::ScratchFolder folder;
        std::mt19937 random(9);
        std::uniform_real_distribution<float> exponent(-100, 100), share(0, 1);
        for (const int width : {5, 8, 200}) { // uncompressed scanlines below 8, run-length encoded from there on
            ImageRgb image(width, 50);
            for (std::size_t i = 0; i < image.size(); ++i)
                image[i] = std::exp2(exponent(random)) * Rgb(share(random), share(random), share(random));
            write_image(folder / "a.hdr", image);
            const ImageRgb again = read_image(folder / "a.hdr");
            double bias = 0;
            for (std::size_t i = 0; i < image.size(); ++i) {
                const Rgbd difference = Rgbd(again[i]) - Rgbd(image[i]);
                const double largest = max_component(image[i]);
                for (std::size_t c = 0; c < 3; ++c) {
                    CHECK(std::abs(difference[c]) <= largest / 256);
                    bias += difference[c] / largest;
                }
            }
            // Errors are uniform within at most ±1/256. The bound is 5 standard deviations of their sum, so a false
            // alarm has odds of 6e-7.
            const double count = 3.0 * static_cast<double>(image.size());
            CHECK(std::abs(bias) < 5 * std::sqrt(count / 3) / 256);
        }
    }

    TEST_CASE("HDR: runs, the largest and smallest values, what it cannot hold") {
        const test::ScratchFolder folder;
        ImageRgb image(400, 3, Rgb(0.5f, 0.25f, 1.0f)); // exactly representable: only the runs are under test
        for (int x = 0; x < 400; x += 1 + x % 7) image(x, 1) = Rgb(static_cast<float>(x % 256), 0, 128);
        image(7, 2) = Rgb(0x1p126f, 0, 0);
        image(8, 2) = Rgb(0x1p-120f, 0, 0);
        write_image(folder / "a.hdr", image);
        CHECK(bitwise_equal(read_image(folder / "a.hdr"), image));

        constexpr float nan = std::numeric_limits<float>::quiet_NaN(),
                        infinity = std::numeric_limits<float>::infinity();
        ImageRgb odd(4, 1);
        odd[0] = {-1, nan, 2};
        odd[1] = {infinity, 1, 1};
        odd[2] = {1e-45f, 0, 0};
        odd[3] = {0.9999f, 0.9999f, 0.5f}; // rounds up to the next power of two
        write_image(folder / "b.hdr", odd);
        const ImageRgb again = read_image(folder / "b.hdr");
        CHECK(again[0] == Rgb(0, 0, 2));
        CHECK(again[1] == Rgb(0x1.fep126f, 0, 0));
        CHECK(again[2] == Rgb(0, 0, 0));
        CHECK(again[3] == Rgb(1, 1, 0.5f));
    }

    TEST_CASE("NaN is black and infinity white in 8-bit files") {
        const test::ScratchFolder folder;
        ImageRgb image(1, 1, Rgb(std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -1));
        write_image(folder / "a.png", image);
        CHECK(read_image(folder / "a.png")[0] == Rgb(0, 1, 0));
    }

    TEST_CASE("gray is spread and alpha dropped") {
        StoredImage grey{2, 1, 2, StoredImage::Encoding::kLinear, {0.5f, 0.1f, 0.75f, 0.2f}};
        CHECK(to_linear(grey)[0] == Rgb(0.5f));
        CHECK(to_linear(grey)[1] == Rgb(0.75f));
        StoredImage rgba{1, 1, 4, StoredImage::Encoding::kEncoded, {1, 0, 0.5f, 0.25f}};
        CHECK(to_linear(rgba)[0] == Rgb(1, 0, srgb_decode(0.5f)));
    }

    TEST_CASE("endings: unknown ones, missing folders and folders in the way are refused before a render") {
        const test::ScratchFolder folder;
        const ImageRgb image(2, 2);
        CHECK(error_of([&] { write_image(folder / "a.bmp", image); }) ==
              Containing("unknown ending .bmp, expected .png"));
        CHECK(error_of([&] { check_writable_image(folder / "a.bmp"); }) == Containing("unknown ending"));
        CHECK(error_of([&] { check_writable_image(folder / "a"); }) == Containing("no ending"));
        CHECK(error_of([&] { check_writable_image(folder / "none/a.png"); }) == Containing("no folder"));
        std::filesystem::create_directory(folder / "b.png");
        CHECK(error_of([&] { check_writable_image(folder / "b.png"); }) == Containing("is a folder"));
        CHECK(error_of([&] { check_writable_image(folder / "a.ExR"); }) == "no error");
        CHECK(error_of([&] { check_writable_image("a.png"); }) == "no error");
    }

    TEST_CASE("a file that cannot be written is an Error with exit code 1, and leaves nothing behind") {
        const test::ScratchFolder folder;
        const ImageRgb image = radiance_image(200, 200);
        for (const char* ending : {"png", "jpg", "tga", "ppm", "pfm", "hdr", "exr"}) {
            CAPTURE(ending);
            CHECK(error_of([&] {
                      write_image(folder / "none" / message("a.", ending), image);
                  }).starts_with("exit code 1: "));
            write_file(folder / "file", "");
            CHECK(error_of([&] {
                      write_image(folder / "file" / message("a.", ending), image);
                  }).starts_with("exit code 1: "));
            // The file size limit stands for a disk that is full after 100 bytes.
            rlimit old_limit{};
            REQUIRE(getrlimit(RLIMIT_FSIZE, &old_limit) == 0);
            const auto old_action = std::signal(SIGXFSZ, SIG_IGN);
            const rlimit small{100, old_limit.rlim_max};
            setrlimit(RLIMIT_FSIZE, &small);
            const std::string error = error_of([&] { write_image(folder / message("a.", ending), image); });
            setrlimit(RLIMIT_FSIZE, &old_limit);
            std::signal(SIGXFSZ, old_action);
            CHECK(error.starts_with("exit code 1: "));
            CHECK(error == Containing("cannot be written"));
            std::filesystem::remove(folder / "file");
            CHECK(std::filesystem::is_empty(folder.path()));
        }
        CHECK(error_of([&] { write_image(folder / "a.png", ImageRgb()); }) == Containing("exit code 1: "));
    }

    TEST_CASE("EXR: named channels of both types and attributes come back") {
        const test::ScratchFolder folder;
        ExrChannel depth{"depth.Z", {}, {}}, object{"hit.object", {}, {}};
        for (std::uint32_t i = 0; i < 30 * 20; ++i) {
            depth.floats.push_back(i == 7 ? std::numeric_limits<float>::infinity() : static_cast<float>(i) * 0.1f);
            object.integers.push_back(0xffffffffu - i * 1234567u);
        }
        write_exr(folder / "a.exr", 30, 20, {object, depth}, {{"duet:scene", "models/cornell.json"}, {"empty", ""}});
        const ExrFile file = read_exr(folder / "a.exr");
        CHECK(file.width == 30);
        CHECK(file.height == 20);
        REQUIRE(file.channels.size() == 2);
        CHECK(file.channels[0].name == "depth.Z");
        CHECK(file.channels[0].floats == depth.floats);
        CHECK(file.channels[0].integers.empty());
        CHECK(file.channels[1].name == "hit.object");
        CHECK(file.channels[1].integers == object.integers);
        const auto value = [&](const std::string& name) {
            for (const ExrAttribute& attribute : file.attributes)
                if (attribute.name == name) return attribute.value;
            return std::string("none");
        };
        CHECK(value("duet:scene") == "models/cornell.json");
        CHECK(value("empty").empty());
        // OpenEXR reserves this attribute.
        CHECK(error_of([&] {
                  write_exr(folder / "b.exr", 30, 20, {depth}, {{"channels", "x"}});
              }).starts_with("exit code 1: "));
        CHECK(!std::filesystem::exists(folder / "b.exr"));
    }

    TEST_CASE("EXR: gray, alpha and integer channels make an image; others are named in the Error") {
        const test::ScratchFolder folder;
        const std::vector<float> one{0.25f}, two{0.5f}, three{4.0f}, four{0.75f};
        write_exr(folder / "grey.exr", 1, 1, {{"Y", one, {}}, {"A", four, {}}});
        CHECK(read_stored_image(folder / "grey.exr").values == std::vector{0.25f, 0.75f});
        CHECK(read_image(folder / "grey.exr")[0] == Rgb(0.25f));
        write_exr(folder / "rgba.exr", 1, 1,
                  {{"A", four, {}}, {"B", three, {}}, {"G", two, {}}, {"R", one, {}}, {"Z", one, {}}});
        CHECK(read_stored_image(folder / "rgba.exr").values == std::vector{0.25f, 0.5f, 4.0f, 0.75f});
        write_exr(folder / "integers.exr", 1, 1, {{"R", {}, {3}}, {"G", two, {}}, {"B", three, {}}});
        CHECK(read_image(folder / "integers.exr")[0] == Rgb(3, 0.5f, 4));
        write_exr(folder / "missing.exr", 1, 1, {{"R", one, {}}, {"depth.Z", two, {}}});
        const std::string error = error_of([&] { read_image(folder / "missing.exr"); });
        CHECK_FALSE(error.starts_with("exit code"));
        CHECK(error == Containing("channels R depth.Z, expected R, G and B, or Y"));
    }
}
