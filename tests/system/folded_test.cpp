#include "system/folded.hpp"

#include <catch2/catch.hpp>

using namespace racebeam;

namespace {

std::string folded(std::string_view text, std::size_t columns, std::size_t column = 0,
                   std::size_t hanging = 0) {
  std::string out;
  append_folded(out, text, columns, column, hanging);
  return out;
}

}  // namespace

TEST_CASE("A line has as many words as fit") {
  CHECK(folded("aa bb cc", 5) == "aa bb\ncc");
  CHECK(folded("aa bbb cc", 5) == "aa\nbbb\ncc");
  CHECK(folded("aa bb cc", 8) == "aa bb cc");
  CHECK(folded("aa bb cc", 7) == "aa bb\ncc");
}

TEST_CASE("The first line begins further right, and the others are indented") {
  CHECK(folded("aa bb", 8, 3) == "aa bb");
  CHECK(folded("aa bb", 8, 4, 2) == "aa\n  bb");
  CHECK(folded("a bbb ccc d e", 5, 0, 1) == "a bbb\n ccc\n d e");
  CHECK(folded("a bbb cc d", 5, 0, 1) == "a bbb\n cc d");
}

TEST_CASE("Blanks between words count as one, and a long word stays whole") {
  CHECK(folded("  a   b  ", 80) == "a b");
  CHECK(folded("", 80).empty());
  CHECK(folded("   ", 80).empty());
  CHECK(folded("longer a", 3, 2, 1) == "longer\n a");
  std::string out = "text: ";
  append_folded(out, "a", 80, 6, 2);
  CHECK(out == "text: a");
}
