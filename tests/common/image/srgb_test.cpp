#include "common/image/srgb.h"

#include <doctest/doctest.h>

#include <limits>

using namespace duet;

namespace {

// Returns the code whose interval [k − ½, k + ½) contains 255·encode(x), computed in long double from the definition.
int nearest_code(float linear) {
    if (!(linear > 0)) return 0;
    const long double x = linear;
    const long double encoded = x <= 0.0031308L ? 12.92L * x : 1.055L * std::pow(x, 1 / 2.4L) - 0.055L;
    return static_cast<int>(std::min(255.0L, std::floor(255 * encoded + 0.5L)));
}

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("the sRGB curve has the standard's known values") {
        CHECK(srgb_encode(0.0) == 0.0);
        CHECK(srgb_encode(1.0) == doctest::Approx(1.0).epsilon(1e-15));
        CHECK(srgb_decode(1.0) == doctest::Approx(1.0).epsilon(1e-15));
        CHECK(srgb_encode(0.002) == doctest::Approx(0.02584).epsilon(1e-12));
        CHECK(srgb_encode(0.5) == doctest::Approx(0.735356983).epsilon(1e-8)); // 1.055·2^(−1/2.4) − 0.055
        CHECK(srgb_decode(0.5) == doctest::Approx(0.214041140).epsilon(1e-8)); // ((0.5 + 0.055)/1.055)^2.4
        CHECK(std::isnan(srgb_encode(std::numeric_limits<float>::quiet_NaN())));
    }

    TEST_CASE("encoding and decoding are inverse and increasing") {
        for (int i = 0; i <= 10000; ++i) {
            const double x = i / 10000.0;
            CAPTURE(x);
            CHECK(std::abs(srgb_decode(srgb_encode(x)) - x) < 1e-8); // the standard's two segments do not meet exactly
            CHECK(std::abs(srgb_decode(srgb_encode(static_cast<float>(x))) - static_cast<float>(x)) < 1e-6f);
            if (i > 0) {
                CHECK(srgb_encode(x) > srgb_encode((i - 1) / 10000.0));
                CHECK(srgb_decode(x) > srgb_decode((i - 1) / 10000.0));
            }
        }
    }

    TEST_CASE("8-bit codes survive decoding and encoding") {
        for (int k = 0; k < 256; ++k) CHECK(srgb_encode_8bit(srgb_decode_8bit(static_cast<std::uint8_t>(k))) == k);
    }

    TEST_CASE(
        "8-bit encoding rounds to nearest: at each change of code, its neighboring floats, and all over the range") {
        for (int k = 0; k < 255; ++k) {
            const auto change = static_cast<float>(srgb_decode((k + 0.5) / 255));
            float x = change;
            for (int i = 0; i < 4; ++i) x = std::nextafter(x, 0.0f);
            for (int i = 0; i < 9; ++i, x = std::nextafter(x, 2.0f)) {
                CAPTURE(k);
                CAPTURE(x);
                CHECK(srgb_encode_8bit(x) == nearest_code(x));
            }
        }
        int last = 0;
        for (std::uint32_t bits = 0; bits <= std::bit_cast<std::uint32_t>(1.5f); bits += 4999) {
            const auto x = std::bit_cast<float>(bits);
            const int code = srgb_encode_8bit(x);
            if (code != nearest_code(x) || code < last)
                FAIL("float " << x << " has code " << code << ", expected " << nearest_code(x));
            last = code;
        }
        CHECK(last == 255);
    }

    TEST_CASE("8-bit encoding clamps, and takes NaN for black") {
        constexpr float infinity = std::numeric_limits<float>::infinity();
        CHECK(srgb_encode_8bit(std::numeric_limits<float>::quiet_NaN()) == 0);
        CHECK(srgb_encode_8bit(-std::numeric_limits<float>::quiet_NaN()) == 0);
        CHECK(srgb_encode_8bit(-infinity) == 0);
        CHECK(srgb_encode_8bit(-1.0f) == 0);
        CHECK(srgb_encode_8bit(-0.0f) == 0);
        CHECK(srgb_encode_8bit(std::numeric_limits<float>::denorm_min()) == 0);
        CHECK(srgb_encode_8bit(1.0f) == 255);
        CHECK(srgb_encode_8bit(std::nextafter(1.0f, 0.0f)) == 255);
        CHECK(srgb_encode_8bit(1e30f) == 255);
        CHECK(srgb_encode_8bit(infinity) == 255);
    }

    TEST_CASE("a whole image is encoded pixel by pixel, whatever the number of threads") {
        ImageRgb image(701, 307); // the size is no multiple of the bands' height
        for (std::size_t i = 0; i < image.size(); ++i) {
            const float x = static_cast<float>(i) / static_cast<float>(image.size());
            image[i] = {x, 1.5f * x - 0.25f, x * x};
        }
        for (const int threads : {1, 3}) {
            const std::vector<std::uint8_t> bytes = srgb_encode_8bit(image, threads);
            REQUIRE(bytes.size() == 3 * image.size());
            std::size_t different = 0;
            for (std::size_t i = 0; i < bytes.size(); ++i)
                different += bytes[i] != srgb_encode_8bit(image[i / 3][i % 3]) ? 1 : 0;
            CHECK(different == 0);
        }
        CHECK(srgb_encode_8bit(ImageRgb()).empty());
    }
}
