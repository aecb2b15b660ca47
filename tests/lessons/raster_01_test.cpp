// The lines of lesson raster-01 are the pixels nearest to the line, and the library's lines are the same but for pixels
// that are equally near.
#include "raster/lessons/01-lines/line.h"
#include "raster/overlay/lines.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace duet;

namespace {

constexpr int kReach = 18, kSize = 2 * kReach + 1; // lines from the middle of the image to any pixel

ImageRgb lesson_line(int dx, int dy) {
    ImageRgb image(kSize, kSize);
    lesson::draw_line(image, kReach, kReach, kReach + dx, kReach + dy, Rgb(1));
    return image;
}

} // namespace

TEST_SUITE("lesson") {

    TEST_CASE("raster-01: a line has one pixel for each column or row, and each is at most half a pixel off") {
        for (int dx = -kReach; dx <= kReach; ++dx)
            for (int dy = -kReach; dy <= kReach; ++dy) {
                const ImageRgb image = lesson_line(dx, dy);
                const int longer = std::max(std::abs(dx), std::abs(dy));
                int count = 0;
                CAPTURE(dx);
                CAPTURE(dy);
                for (int y = -kReach; y <= kReach; ++y)
                    for (int x = -kReach; x <= kReach; ++x) {
                        if (image(kReach + x, kReach + y) == Rgb(0)) continue;
                        ++count;
                        // |x·dy - y·dx| / longer is the distance along the shorter axis.
                        REQUIRE(2 * std::abs(x * dy - y * dx) <= longer);
                        REQUIRE(x * dx >= 0);
                        REQUIRE(y * dy >= 0);
                        REQUIRE(std::abs(x) <= std::abs(dx));
                        REQUIRE(std::abs(y) <= std::abs(dy));
                    }
                REQUIRE(count == longer + 1);
                REQUIRE(image(kReach, kReach) == Rgb(1));
                REQUIRE(image(kReach + dx, kReach + dy) == Rgb(1));
            }
    }

    TEST_CASE("raster-01: the library marks the pixels that the lesson draws") {
        const raster::SampleOffset center;
        const auto fixed = [&](int x, int y) {
            return raster::FixedPoint{x * raster::kSubpixels + center.x, y * raster::kSubpixels + center.y};
        };
        int compared = 0;
        for (int dx = -kReach; dx <= kReach; ++dx)
            for (int dy = -kReach; dy <= kReach; ++dy) {
                const ImageRgb lesson = lesson_line(dx, dy);
                Image<std::uint8_t> library(kSize, kSize, 0);
                raster::draw_line(fixed(kReach, kReach), fixed(kReach + dx, kReach + dy), center, library);
                library(kReach, kReach) = library(kReach + dx, kReach + dy) = 1; // it leaves out one of the ends
                const int longer = std::max(std::abs(dx), std::abs(dy)), shorter = std::min(std::abs(dx), std::abs(dy));
                bool tie = false; // whether some pixels are equally near
                for (int i = 0; i < longer; ++i) tie = tie || (2 * i * shorter) % (2 * longer) == longer;
                if (tie) continue;
                ++compared;
                CAPTURE(dx);
                CAPTURE(dy);
                for (std::size_t i = 0; i < lesson.size(); ++i) REQUIRE((lesson[i] == Rgb(1)) == (library[i] == 1));
            }
        CHECK(compared > 500);
    }
}
