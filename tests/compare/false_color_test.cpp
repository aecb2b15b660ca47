#include "compare/report/false_color.h"

#include <doctest/doctest.h>

#include <limits>

using namespace duet;
using namespace duet::compare;

TEST_SUITE("unit") {

    TEST_CASE("positive is orange, negative blue, zero near white; further from zero is darker on both sides") {
        CHECK(diverging_color(0.7).r > diverging_color(0.7).b);
        CHECK(diverging_color(-0.7).b > diverging_color(-0.7).r);
        CHECK(luminance(diverging_color(0)) > 0.9f);
        for (const double sign : {-1.0, 1.0})
            for (int i = 1; i <= 20; ++i)
                CHECK(luminance(diverging_color(sign * i / 20)) < luminance(diverging_color(sign * (i - 1) / 20)));
        CHECK(diverging_color(5) == diverging_color(1));
        CHECK(diverging_color(-5) == diverging_color(-1));
    }

    TEST_CASE("the difference image: A − B over the range, magenta where there is no number") {
        ImageRgb a(3, 1, Rgb(1.0f)), b(3, 1, Rgb(1.0f));
        a[1] = Rgb(2.0f);
        b[2].g = std::numeric_limits<float>::quiet_NaN();
        const ImageRgb image = difference_image(a, b, 1);
        CHECK(luminance(image[0]) > 0.85f);
        CHECK(image[1].r > image[1].b);
        CHECK(image[2] == Rgb(1, 0, 1));
    }

    TEST_CASE("the range is a round number over the 99th percentile") {
        ImageRgb a(100, 1), b(100, 1);
        for (int x = 0; x < 100; ++x) a(x, 0) = Rgb(0.003f);
        CHECK(difference_range(a, b) == doctest::Approx(0.005));
        a(7, 0) = Rgb(100.0f); // one outlier in a hundred does not set the scale
        CHECK(difference_range(a, b) == doctest::Approx(0.005));
        CHECK(difference_range(a, a) == doctest::Approx(0.001));
        CHECK(difference_range(ImageRgb(1, 1, Rgb(0.02f)), ImageRgb(1, 1)) == doctest::Approx(0.02).epsilon(1e-5));
    }
}
