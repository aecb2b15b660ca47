#include "common/system/escape.h"

#include <doctest/doctest.h>

using namespace duet;

TEST_SUITE("unit") {

    TEST_CASE("printable characters stay, control characters and bytes that are not UTF-8 are escaped") {
        CHECK(escaped("") == "");
        CHECK(escaped("a ~ ü € 😀") == "a ~ ü € 😀");
        CHECK(escaped(std::string_view("\0\n\x1b\x7f", 4)) == "\\x00\\x0a\\x1b\\x7f");
        CHECK(escaped("\xc2\x9b|\xc2\xa0") ==
              "\\xc2\\x9b|\xc2\xa0"); // C1's control sequence introducer, a no-break space
        CHECK(escaped("\x9b") == "\\x9b");
        CHECK(escaped("\xe2\x82") == "\\xe2\\x82");                   // cut off
        CHECK(escaped("\xc0\xaf") == "\\xc0\\xaf");                   // longer than necessary
        CHECK(escaped("\xed\xa0\x80") == "\\xed\\xa0\\x80");          // a surrogate
        CHECK(escaped("\xf4\x90\x80\x80") == "\\xf4\\x90\\x80\\x80"); // beyond U+10FFFF
    }

    TEST_CASE("a text is cut in its middle to a number of characters, never within one") {
        CHECK(shortened("abc", 3) == "abc");
        CHECK(shortened("abcd", 3) == "a…d");
        CHECK(shortened("abcdefgh", 6) == "ab…fgh");
        CHECK(shortened("üüüüüüüü", 8) == "üüüüüüüü");
        CHECK(shortened("üüüüüüüü", 7) == "üüü…üüü");
    }
}
