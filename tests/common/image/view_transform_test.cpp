#include "common/image/view_transform.h"

#include "common/image/image_file.h"
#include "common/image/srgb.h"
#include "tests/support/scratch.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>

using namespace duet;
using duet::test::ScratchFolder;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

ImageRgb gradient() {
    ImageRgb image(64, 32);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x) image(x, y) = Rgb(0.05f * float(x), 0.02f * float(y), 0.001f * float(x * y));
    return image;
}

// Returns the value in the code range of the display, of gamma 2.2, that AgX gives for a position in its range of 16.5
// stops, as approximated by Wrensch (2023).
double wrensch_polynomial(double x) {
    return 15.5 * std::pow(x, 6) - 40.14 * std::pow(x, 5) + 31.96 * std::pow(x, 4) - 6.868 * std::pow(x, 3) +
           0.4298 * x * x + 0.1191 * x - 0.00232;
}

float saturation(Rgb c) { return 1 - std::min({c.r, c.g, c.b}) / max_component(c); }

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("the default view transform is the sRGB curve alone, and exposure scales radiance") {
        const ImageRgb image = gradient();
        CHECK(display_bytes(image, {}) == srgb_encode_8bit(image));
        ImageRgb doubled = image;
        for (Rgb& pixel : doubled.pixels()) pixel *= 2.0f;
        CHECK(display_bytes(image, {.exposure = 1}) == srgb_encode_8bit(doubled));
    }

    TEST_CASE("tone curves rise from 0 to at most 1, and keep gray") {
        for (const Tone tone : {Tone::kNone, Tone::kFilmic, Tone::kAgx}) {
            CAPTURE(kTones.name(tone));
            const ToneMapping& mapping = tone_mapping(tone);
            CHECK(mapping.curve(0) == doctest::Approx(0).epsilon(1e-6));
            float last = 0;
            for (float x = 1e-6f; x < 1e6f; x *= 1.03f) {
                const float y = mapping.curve(x);
                CHECK(y >= last);
                CHECK(y <= 1);
                last = y;
                const Rgb gray = mapping(Rgb(x));
                CHECK(gray.r == doctest::Approx(y).epsilon(1e-5));
                CHECK(std::max(std::abs(gray.g - gray.r), std::abs(gray.b - gray.r)) < 1e-6f);
            }
            CHECK(last > 0.98f);
        }
    }

    TEST_CASE("the tone curves are the published ones") {
        CHECK(tone_mapping(Tone::kFilmic).curve(0.18f) == doctest::Approx(0.18).epsilon(1e-3));
        // Narkowicz's curve at 1, with the argument scaled to 0.7232: 2.51·0.7232² + 0.03·0.7232 = 1.3345 over
        // 2.43·0.7232² + 0.59·0.7232 + 0.14 = 1.8376.
        CHECK(tone_mapping(Tone::kFilmic).curve(1) == doctest::Approx(1.3345 / 1.8376).epsilon(1e-4));
        CHECK(tone_mapping(Tone::kAgx).curve(0.18f) == doctest::Approx(std::pow(0.5, 2.2)).epsilon(1e-6));
        for (int i = 0; i <= 1000; ++i) {
            const double position = i / 1000.0, linear = 0.18 * std::exp2(16.5 * position - 10);
            const double code = std::pow(tone_mapping(Tone::kAgx).curve(static_cast<float>(linear)), 1 / 2.2);
            CHECK(std::abs(code - wrensch_polynomial(position)) < 0.006); // its mean squared error is 3.7e-6
        }
    }

    TEST_CASE("AgX makes bright colors paler; clipping changes their hue") {
        const Rgb orange(1, 0.4f, 0.05f);
        float last = 1;
        for (const float stops : {0.0f, 2.0f, 4.0f, 6.0f}) {
            const float s = saturation(displayed(orange, {.exposure = stops, .tone = Tone::kAgx}));
            CHECK(s < last);
            last = s;
        }
        const Rgb clipped = displayed(orange, {.exposure = 2});
        CHECK(std::min(clipped.r, 1.0f) == std::min(clipped.g, 1.0f)); // yellow
    }

    TEST_CASE("NaN, infinite and negative radiance have a code, with every tone") {
        ImageRgb image(4, 1);
        image(0, 0) = Rgb(kNan), image(1, 0) = Rgb(-1), image(2, 0) = Rgb(kInfinity), image(3, 0) = Rgb(3e38f);
        for (const Tone tone : {Tone::kNone, Tone::kFilmic, Tone::kAgx})
            for (const bool dither : {false, true}) {
                const std::vector<std::uint8_t> codes = display_bytes(image, {32, tone, dither});
                CHECK(std::all_of(codes.begin(), codes.begin() + 6, [](int code) { return code == 0; }));
                CHECK(std::all_of(codes.begin() + 6, codes.end(), [](int code) { return code == 255; }));
            }
    }

    TEST_CASE("dithering keeps the mean, and changes a code by less than one") {
        for (const float value : {0.0f, 0.0003f, 0.01f, 0.2031f, 0.5f, 0.87f, 1.0f}) {
            CAPTURE(value);
            const ImageRgb image(256, 256, Rgb(value));
            const double exact = 255 * srgb_encode(static_cast<double>(value));
            double sum = 0;
            for (const std::uint8_t code : display_bytes(image, {.dither = true})) {
                CHECK(std::abs(code - exact) < 1);
                sum += code;
            }
            CHECK(std::abs(sum / (3 * 256 * 256) - exact) < 0.002);
        }
    }

    TEST_CASE("the codes do not depend on the number of threads") {
        const ViewTransform view{0.5f, Tone::kAgx, true};
        CHECK(display_bytes(gradient(), view, 1) == display_bytes(gradient(), view, 3));
    }

    TEST_CASE("the view transform changes 8-bit files alone") {
        const ScratchFolder folder;
        const ImageRgb image = gradient();
        const WriteOptions options{.view = {1, Tone::kFilmic, false}};
        for (const char* name : {"a.exr", "a.pfm"}) {
            write_image(folder / name, image, options);
            CHECK(read_image(folder / name).pixels() == image.pixels());
        }
        const std::vector<std::uint8_t> codes = display_bytes(image, options.view);
        for (const char* name : {"a.png", "a.tga", "a.ppm"}) {
            write_image(folder / name, image, options);
            CHECK(srgb_encode_8bit(read_image(folder / name)) == codes);
        }
    }
}
