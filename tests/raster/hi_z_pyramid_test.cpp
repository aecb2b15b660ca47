// These tests compare the nearest depth in a region of a map with an exhaustive search.
#include "common/sampling/hash.h"
#include "raster/visibility/hi_z_pyramid.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace duet;

TEST_SUITE("unit") {

    TEST_CASE("the greatest number in any part of an image: never less, never more than that of four times the part around it") {
        for (const auto& size : {std::pair(1, 1), std::pair(64, 64), std::pair(37, 100)}) {
            const int width = size.first, height = size.second;
            ImageFloat image(width, height);
            for (std::size_t i = 0; i < image.size(); ++i) image[i] = unit_float(high_bits(stream_number(7, i)));
            const raster::HiZPyramid pyramid(image);
            const auto greatest = [&](int x0, int y0, int x1, int y1) {
                float most = 0;
                for (int y = std::max(y0, 0); y <= std::min(y1, height - 1); ++y)
                    for (int x = std::max(x0, 0); x <= std::min(x1, width - 1); ++x) most = std::max(most, image(x, y));
                return most;
            };
            int exact = 0;
            for (std::uint64_t i = 0; i < 2000; ++i) {
                const auto number = [&](std::uint64_t k, int below) {
                    return static_cast<int>(stream_number(11, 4 * i + k) % static_cast<std::uint64_t>(below));
                };
                const int x0 = number(0, width), y0 = number(1, height);
                const int x1 = std::min(x0 + number(2, 12), width - 1), y1 = std::min(y0 + number(3, 12), height - 1);
                const int reach = 2 * (std::max(x1 - x0, y1 - y0) + 1);
                const float found = pyramid.max_over(x0, y0, x1, y1), least = greatest(x0, y0, x1, y1);
                CHECK(found >= least);
                CHECK(found <= greatest(x0 - reach, y0 - reach, x1 + reach, y1 + reach));
                exact += found == least;
            }
            CHECK(exact > 100);
            CHECK(pyramid.max_over() == greatest(0, 0, width, height));
        }
    }
}
