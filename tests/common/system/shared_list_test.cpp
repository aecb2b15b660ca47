// These tests check that copies of a SharedList share elements, and that an edit is seen in one list alone.
#include "common/system/shared_list.h"

#include <doctest/doctest.h>

#include <string>

using duet::SharedList;

TEST_SUITE("unit") {
    TEST_CASE("copies share the elements until one is edited") {
        SharedList<std::string> first{"a", "b"};
        const std::string* b = &first[1];
        SharedList<std::string> second = first;
        CHECK(&second[1] == b);
        second.edit(1) += "!";
        CHECK(second[1] == "b!");
        CHECK(first[1] == "b");
        CHECK(&first[1] == b);
        CHECK(&second[0] == &first[0]);
        CHECK(&second.edit(1) == &second[1]); // it is no longer shared, so this does not copy it
    }

    TEST_CASE("an element is found by what it is, not by what it equals") {
        const SharedList<int> first{7, 7, 7};
        SharedList<int> second{7};
        second.push_back(first.shared(2));
        for (const std::size_t guess : {std::size_t{0}, std::size_t{1}, std::size_t{9}}) {
            CHECK(second.index_of(first.shared(2), guess) == 1);
            CHECK(second.index_of(first.shared(0), guess) == second.size());
        }
    }
}
