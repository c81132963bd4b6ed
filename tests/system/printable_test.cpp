#include "system/printable.hpp"

#include <catch2/catch.hpp>

using racebeam::printable;
using namespace std::string_literals;

TEST_CASE("text without control characters is shown as it is") {
  for (const char* text :
       {"", "pong.bin", "a b~", "L\xC3\xB6we", "\xE2\x82\xAC", "\xF0\x9F\x8E\xAE", "\xC2\xA0"})
    CHECK(printable(text) == text);
}

TEST_CASE("control characters are shown by their bytes") {
  CHECK(printable("a\x1B[31m\nb\t\x7F") == "a\\x1b[31m\\x0ab\\x09\\x7f");
  CHECK(printable("\0x"s) == "\\x00x");
  CHECK(printable("\xC2\x9B"s + "31m") ==
        "\\xc2\\x9b31m");  // the control sequence introducer in one character
}

TEST_CASE("bytes that are not UTF-8 are shown by their values") {
  CHECK(printable("\x9B"s + "1m") == "\\x9b1m");
  CHECK(printable("\xC3") == "\\xc3");           // cut off
  CHECK(printable("\xC3z") == "\\xc3z");         // not continued
  CHECK(printable("\xC0\x8A") == "\\xc0\\x8a");  // a line feed, longer than needed
  CHECK(printable("\xE0\x80\x9B") == "\\xe0\\x80\\x9b");
  CHECK(printable("\xED\xA0\x80") == "\\xed\\xa0\\x80");           // a surrogate
  CHECK(printable("\xF4\x90\x80\x80") == "\\xf4\\x90\\x80\\x80");  // beyond the last
  CHECK(printable("\xFF") == "\\xff");
}

TEST_CASE("the first and the last character of each length are shown, and those beside them are not") {
  for (const char* text : {" ", "~", "\xC2\xA0", "\xDF\xBF", "\xE0\xA0\x80", "\xED\x9F\xBF", "\xEE\x80\x80",
                           "\xEF\xBF\xBF", "\xF0\x90\x80\x80", "\xF4\x8F\xBF\xBF"})
    CHECK(printable(text) == text);
  for (const char* text :
       {"\x1F", "\x7F", "\xC2\x80", "\xC2\x9F", "\xED\xA0\x80", "\xED\xBF\xBF", "\xF4\x90\x80\x80"})
    CHECK(printable(text).starts_with("\\x"));
  for (const char* longer : {"\xC1\xBF", "\xE0\x9F\xBF", "\xF0\x8F\xBF\xBF"})  // 7F, 7FF, FFFF
    CHECK(printable(longer).starts_with("\\x"));
}
