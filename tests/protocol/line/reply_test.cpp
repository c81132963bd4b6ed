#include "protocol/line/reply.hpp"

#include <catch2/catch.hpp>
#include <string>

#include "protocol/line/commands/command_table.hpp"

using namespace racebeam;

namespace {

// A reply to `look` with a field whose bytes follow the line.
void write(Reply& reply, const std::string& raw) {
  reply.begin();
  reply.answer(find_command("look"));
  reply.add_fields([&](std::string& out, std::string& more) {
    out += " ram=" + std::to_string(raw.size());
    more += raw;
  });
}

}  // namespace

TEST_CASE("An error shows printable bytes as they are, and one question mark for each other") {
  Reply reply;
  reply.begin();
  reply.refuse(ErrorCode::kBadValue, "\x01\x1F !}~\x7F\x80\xFF\n");
  reply.finish();
  CHECK(reply.text() == "error bad-value ?? !}~????\n");
}

TEST_CASE("Raw bytes follow the line of their reply, and no other") {
  Reply reply;
  write(reply, "a\nb");
  const std::string whole = "ok ram=3 raw=3\na\nb";
  CHECK(reply.finish() == whole.size());
  CHECK(reply.text() == whole);
  reply.sent(reply.text().size());
  write(reply, "");
  reply.finish();
  CHECK(reply.text() == "ok ram=0\n");
}

TEST_CASE("An error takes the place of all that its request has written, and of nothing before") {
  Reply reply;
  write(reply, "abc");
  reply.finish();
  const std::string first(reply.text());
  write(reply, "def");
  reply.refuse(ErrorCode::kLimit, "too long");
  const std::string error = "error limit too long\n";
  CHECK(reply.finish() == error.size());
  CHECK(reply.text() == first + error);
}

TEST_CASE("A reply in progress stays whole while those before it are sent") {
  Reply reply;
  write(reply, "abc");
  reply.finish();
  const std::size_t first = reply.text().size();
  write(reply, "");
  CHECK(reply.begin_of_last() == first);
  reply.sent(5);
  CHECK(reply.begin_of_last() == first - 5);
  reply.sent(first - 5);
  CHECK(reply.begin_of_last() == 0);
  CHECK(reply.text() == "ok ram=0");
  CHECK(reply.finish() == 9);
  reply.sent(4);
  CHECK(reply.text() == "am=0\n");
  reply.sent(5);
  CHECK(reply.text().empty());
}
