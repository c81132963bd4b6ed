#include "protocol/classic/classic_line_buffer.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

using namespace racebeam;

namespace {

void put(LineBuffer& buffer, const std::string& text) {
  const std::span<char> space = buffer.space();
  REQUIRE(text.size() <= space.size());
  std::copy(text.begin(), text.end(), space.begin());
  buffer.added(text.size());
}

}  // namespace

TEST_CASE("Lines come out in order, without their LF") {
  LineBuffer buffer;
  put(buffer, "1,1,0,1\n3,18\n\n4,");
  CHECK(buffer.line(100) == "1,1,0,1");
  CHECK(buffer.line(100) == "3,18");
  CHECK(buffer.line(100) == "");
  CHECK_FALSE(buffer.line(100));
  CHECK(buffer.rest() == "4,");
  put(buffer, "18\n");
  CHECK(buffer.line(100) == "4,18");
  CHECK(buffer.rest().empty());
}

TEST_CASE("A line that comes a byte at a time is given once it is whole") {
  LineBuffer buffer;
  for (const char letter : std::string("3,18")) {
    put(buffer, {letter});
    CHECK_FALSE(buffer.line(100));
  }
  put(buffer, "\n");
  CHECK(buffer.line(100) == "3,18");
}

TEST_CASE("A longer line is seen as two") {
  LineBuffer buffer;
  put(buffer, std::string(10, 'a') + "\n" + std::string(9, 'b') + "\n");
  CHECK(buffer.line(10) == std::string(10, 'a'));
  CHECK(buffer.line(10) == "");
  CHECK(buffer.line(10) == std::string(9, 'b'));  // with its LF it just fits
  CHECK_FALSE(buffer.line(10));
}

TEST_CASE("There is always room when no line is ready") {
  LineBuffer buffer;
  std::size_t size = 0;
  for (int turn = 0; turn < 5000; ++turn) {
    const std::size_t room = buffer.space().size();
    REQUIRE(room > 0);
    put(buffer, std::string(std::min<std::size_t>(room, 1 + turn % 700), 'x'));
    while (const auto line = buffer.line(2047)) size += line->size();
  }
  CHECK(size > 1'000'000);
}
