#include "compare/report/encode.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>
#include <zlib.h>

using namespace duet::compare;

namespace {

std::string decode_base64(const std::string& text) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        if (c == '=') break;
        bits = bits << 6 | static_cast<std::uint32_t>(digits.find(c));
        if ((count += 6) >= 8) bytes += static_cast<char>(bits >> (count -= 8) & 255);
    }
    return bytes;
}

/// Decodes a plane as decode.js does.
std::vector<std::uint32_t> decode_plane(const std::string& text, std::size_t pixels, std::size_t width,
                                        std::size_t bytes) {
    const std::string packed = decode_base64(text);
    std::string planes(pixels * bytes, '\0');
    uLongf size = planes.size();
    REQUIRE(uncompress(reinterpret_cast<Bytef*>(planes.data()), &size, reinterpret_cast<const Bytef*>(packed.data()),
                       packed.size()) == Z_OK);
    REQUIRE(size == planes.size());
    const std::uint32_t mask = bytes == 4 ? ~0u : (1u << (8 * bytes)) - 1;
    std::vector<std::uint32_t> values(pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
        std::uint32_t difference = 0;
        for (std::size_t b = 0; b < bytes; ++b)
            difference = difference << 8 | static_cast<unsigned char>(planes[b * pixels + i]);
        values[i] = (difference + (i % width == 0 ? 0 : values[i - 1])) & mask;
    }
    return values;
}

double half_value(std::uint16_t bits) {
    const int exponent = bits >> 10 & 31, fraction = bits & 1023;
    const double size = exponent == 31  ? (fraction != 0 ? std::nan("") : std::numeric_limits<double>::infinity())
                        : exponent == 0 ? std::ldexp(fraction, -24)
                                        : std::ldexp(1024 + fraction, exponent - 25);
    return (bits & 0x8000) != 0 ? -size : size;
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("every half-precision number survives, and what lies between goes to the nearer neighbor, ties to even") {
        for (std::uint32_t bits = 0; bits < 0x7bff; ++bits) {
            const double low = half_value(static_cast<std::uint16_t>(bits)),
                         high = half_value(static_cast<std::uint16_t>(bits + 1));
            const auto middle = static_cast<float>((low + high) / 2);
            CAPTURE(bits);
            REQUIRE(half_bits(static_cast<float>(low)) == bits);
            REQUIRE(half_bits(std::nextafter(middle, 0.0f)) == bits);
            REQUIRE(half_bits(std::nextafter(middle, 1e9f)) == bits + 1);
            REQUIRE(half_bits(middle) == (bits % 2 == 0 ? bits : bits + 1));
            REQUIRE(half_bits(-static_cast<float>(low)) == (bits | 0x8000));
        }
        CHECK(half_bits(65504.0f) == 0x7bff);
        CHECK(half_bits(1e9f) == 0x7bff);
        CHECK(half_bits(std::numeric_limits<float>::infinity()) == 0x7c00);
        CHECK(std::isnan(half_value(half_bits(std::numeric_limits<float>::quiet_NaN()))));
        CHECK(half_bits(1e-30f) == 0);
    }

    TEST_CASE("base64: the test vectors of RFC 4648, §10") {
        CHECK(base64("").empty());
        CHECK(base64("f") == "Zg==");
        CHECK(base64("fo") == "Zm8=");
        CHECK(base64("foo") == "Zm9v");
        CHECK(base64("foob") == "Zm9vYg==");
        CHECK(base64("fooba") == "Zm9vYmE=");
        CHECK(base64("foobar") == "Zm9vYmFy");
        CHECK(base64("\xff\xfe") == "//4=");
    }

    TEST_CASE("planes come back as they were, whatever their width and range") {
        std::mt19937 random(5);
        for (const int bytes : {1, 2, 4})
            for (const int width : {1, 7, 64}) {
                std::vector<std::uint32_t> values(static_cast<std::size_t>(width) * 13);
                for (std::uint32_t& v : values)
                    v = static_cast<std::uint32_t>(random()) & (bytes == 4 ? ~0u : (1u << (8 * bytes)) - 1);
                const auto columns = static_cast<std::size_t>(width);
                CHECK(decode_plane(encode_plane(values, width, bytes), values.size(), columns,
                                   static_cast<std::size_t>(bytes)) == values);
            }
    }

    TEST_CASE("a smooth image becomes small") {
        std::vector<std::uint32_t> values(256 * 256);
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::uint32_t>(i / 256 + 3 * (i % 256));
        CHECK(encode_plane(values, 256, 4).size() < values.size() / 20);
    }
}
