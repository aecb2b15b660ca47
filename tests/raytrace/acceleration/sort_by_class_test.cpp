#include "raytrace/acceleration/sort_by_class.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

using namespace duet;
using namespace duet::raytrace;

TEST_SUITE("unit") {

    TEST_CASE("sorted by class, indices of any number are as a stable sort leaves them") {
        const auto class_of = [](std::uint32_t i) { return i * i % 11 % 5; }; // no item has class 2
        for (std::uint32_t size = 0; size < 40; ++size) {
            std::vector<std::uint32_t> indices(size);
            for (std::uint32_t k = 0; k < size; ++k) indices[k] = 7 * k % 41;
            std::vector<std::uint32_t> expected = indices, sorted(size);
            std::vector<std::uint8_t> classes(size);
            std::stable_sort(expected.begin(), expected.end(),
                             [&](auto a, auto b) { return class_of(a) < class_of(b); });
            const auto ends = sort_by_class<5>(indices, class_of, classes, sorted);
            CAPTURE(size);
            CHECK(sorted == expected);
            for (std::uint32_t c = 0; c < 5; ++c)
                CHECK(ends[c] ==
                      std::count_if(indices.begin(), indices.end(), [&](auto i) { return class_of(i) <= c; }));
        }
    }

} // TEST_SUITE
