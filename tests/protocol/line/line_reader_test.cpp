#include "protocol/line/line_reader.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <optional>
#include <string>
#include <vector>

using namespace racebeam;

namespace {

constexpr std::size_t kLongest = 20'000;

// A reader whose client has sent nothing yet, and what it has read.
struct Input {
  // As a session does: takes lines until it needs more input, which then has space.
  void read() {
    while (true) {
      while (const auto line = reader.next()) lines.push_back({line->kind, std::string(line->text)});
      if (reader.ended() || reader.growth() == 0) return;
      ++growths;
      reader.grow();
    }
  }
  void send(std::string_view text) {
    while (!text.empty()) {
      const std::span<char> space = reader.space();
      REQUIRE_FALSE(space.empty());
      const std::size_t count = std::min(space.size(), text.size());
      std::copy_n(text.begin(), count, space.begin());
      reader.added(count);
      text.remove_prefix(count);
      read();
    }
  }

  struct Read {
    LineReader::Kind kind;
    std::string text;
    bool operator==(const Read&) const = default;
  };
  LineReader reader{kLongest};
  std::vector<Read> lines;
  int growths = 0;
};

Input::Read whole(const std::string& text) { return {LineReader::Kind::kLine, text}; }
const Input::Read kTooLong{LineReader::Kind::kTooLong, ""}, kCut{LineReader::Kind::kCut, ""};

}  // namespace

TEST_CASE("A reader gives lines without LF, and without a CR before it") {
  Input input;
  input.send("one\r\n\n\r\ntwo\rthree\nfour");
  CHECK(input.lines == std::vector{whole("one"), whole(""), whole(""), whole("two\rthree")});
  CHECK_FALSE(input.reader.empty());
  input.send("\n\n");
  CHECK(input.lines.size() == 6);
  CHECK(input.lines[4] == whole("four"));
  CHECK(input.reader.empty());
}

TEST_CASE("A line may have the longest length, in pieces and at once, and no byte more") {
  const std::string longest(kLongest, 'x');
  for (const std::string& end : {std::string("\n"), std::string("x\n")}) {
    Input pieces, once;
    pieces.send(longest);
    CHECK(pieces.lines.empty());
    pieces.send(end);
    once.send(longest + end + "next\n");
    const bool fits = end.size() == 1;
    CHECK(pieces.lines == std::vector{fits ? whole(longest) : kTooLong});
    CHECK(once.lines == std::vector{fits ? whole(longest) : kTooLong, whole("next")});
  }
}

TEST_CASE("A line that is too long is reported before its end, once, and holds no space") {
  Input input;
  for (int part = 0; part < 10; ++part) input.send(std::string(kLongest, 'x'));
  CHECK(input.lines == std::vector{kTooLong});
  CHECK(input.reader.empty());
  input.send("\n");
  input.send("\nnext\n");
  CHECK(input.lines == std::vector{kTooLong, whole(""), whole("next")});
}

TEST_CASE("A line that is cut is reported once, and the next one is read") {
  Input input;
  input.send("half of ");
  input.reader.cut_line();
  input.read();
  CHECK(input.lines == std::vector{kCut});
  input.send("a line");
  input.send("\nnext\nhalf");
  CHECK(input.lines == std::vector{kCut, whole("next")});
  input.send("\n");
  CHECK(input.lines.back() == whole("half"));
}

TEST_CASE("What is left at the end is half a line, once") {
  Input input;
  input.send("whole\nhalf");
  input.reader.end();
  input.read();
  CHECK(input.lines == std::vector{whole("whole"), {LineReader::Kind::kHalf, "half"}});
  input.read();
  CHECK(input.lines.size() == 2);
  CHECK(input.reader.empty());
}

TEST_CASE("There is space for more input, however much of the buffer a half line takes") {
  for (const std::size_t before : {0, 1, 2, 100}) {
    CAPTURE(before);
    Input input;
    const std::size_t size = input.reader.space().size();
    input.send(std::string(before, '\n') + std::string(size - before, 'x'));
    CHECK_FALSE(input.reader.space().empty());
    input.send("y\n");
    CHECK(input.lines.size() == before + 1);
    CHECK(input.lines.back() == whole(std::string(size - before, 'x') + "y"));
  }
}

TEST_CASE("The buffer grows with its line, by doubling, to no more than the longest and a piece") {
  Input input;
  const std::size_t idle = input.reader.space().size();
  std::string sent;
  while (sent.size() + 100 <= kLongest) {
    input.send(std::string(100, 'x'));
    sent.append(100, 'x');
    const std::size_t space = input.reader.space().size();
    CHECK(space > 0);
    CHECK(sent.size() + space <= std::min(std::max(idle, 2 * sent.size()), kLongest + idle));
    CHECK(input.reader.growth() == 0);
  }
  CHECK(input.growths <= 4);
  input.send("\n");
  CHECK(input.lines == std::vector{whole(sent)});
}

TEST_CASE("An idle reader holds no more than a new one") {
  Input input;
  const std::size_t idle = input.reader.capacity();
  input.send(std::string(kLongest, 'x') + "\n");
  CHECK(input.reader.capacity() > idle);
  input.reader.space();
  CHECK(input.reader.capacity() == idle);
  CHECK(input.reader.space().size() == LineReader(kLongest).space().size());
}

TEST_CASE("Whole lines that wait are counted up to a number") {
  LineReader reader(kLongest);
  const std::string text = "a\n\n\nb\nhalf";
  std::ranges::copy(text, reader.space().begin());
  reader.added(text.size());
  CHECK(reader.lines(10) == 4);
  CHECK(reader.lines(4) == 4);
  CHECK(reader.lines(3) == 3);
  CHECK(reader.lines(0) == 0);
  reader.next();
  CHECK(reader.lines(10) == 3);
  for (int line = 0; line < 4; ++line) reader.next();
  CHECK(reader.lines(10) == 0);
}
