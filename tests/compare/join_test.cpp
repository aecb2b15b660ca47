#include "compare/join.h"

#include "common/image/image_file.h"
#include "common/system/error.h"
#include "tests/support/scratch.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::compare;
using duet::test::ScratchFolder;

namespace {

const Rgb kRed(1, 0, 0), kGreen(0, 1, 0), kBlue(0, 0, 1), kWhite(1);

std::vector<ImageRgb> three_images(int width, int height) {
    return {ImageRgb(width, height, kRed), ImageRgb(width, height, kGreen), ImageRgb(width, height, kBlue)};
}

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("a grid has its images row by row, and white between them and in the cells that remain") {
        const ImageRgb grid = image_grid(three_images(4, 3), 2, 1);
        REQUIRE(grid.width() == 9);
        REQUIRE(grid.height() == 7);
        CHECK(grid(0, 0) == kRed);
        CHECK(grid(3, 2) == kRed);
        CHECK(grid(4, 0) == kWhite);
        CHECK(grid(5, 0) == kGreen);
        CHECK(grid(0, 3) == kWhite);
        CHECK(grid(0, 4) == kBlue);
        CHECK(grid(8, 6) == kWhite);
    }

    TEST_CASE("bands are equally wide, and lean to the right by the angle") {
        const ImageRgb upright = image_bands(three_images(30, 20), 0, 0);
        for (int y = 0; y < 20; ++y)
            for (int x = 0; x < 30; ++x) CHECK(upright(x, y) == (x < 10 ? kRed : x < 20 ? kGreen : kBlue));
        // At 45 degrees, the line is 9.5 pixels to the right of its middle in the top row, as far to the left in the
        // bottom row, and divides the pixels that it crosses.
        const ImageRgb leaning = image_bands({ImageRgb(40, 20, kRed), ImageRgb(40, 20, kBlue)}, 0, 45);
        CHECK(leaning(28, 0) == kRed);
        CHECK(leaning(30, 0) == kBlue);
        CHECK(leaning(9, 19) == kRed);
        CHECK(leaning(11, 19) == kBlue);
        CHECK(leaning(29, 0).r == doctest::Approx(0.5));
    }

    TEST_CASE("the gap of bands is a white line over their border") {
        const ImageRgb image = image_bands({ImageRgb(20, 4, kRed), ImageRgb(20, 4, kBlue)}, 2, 0);
        CHECK(image(8, 1) == kRed);
        CHECK(image(9, 1) == kWhite);
        CHECK(image(10, 1) == kWhite);
        CHECK(image(11, 1) == kBlue);
    }

    TEST_CASE("images of different size are refused, and named") {
        const ScratchFolder scratch;
        write_image(scratch / "a.pfm", ImageRgb(4, 4));
        write_image(scratch / "b.pfm", ImageRgb(4, 5));
        JoinOptions options;
        options.images = {scratch / "a.pfm", scratch / "b.pfm"};
        options.output = scratch / "out.pfm";
        CHECK_THROWS_WITH_AS(join_images(options), doctest::Contains("b.pfm 4x5"), Error);
        options.images = {scratch / "a.pfm", scratch / "a.pfm"};
        CHECK(join_images(options) == 0);
        CHECK(read_image(options.output).width() == 8);
    }
}
