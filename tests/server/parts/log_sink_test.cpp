#include "server/operation/log_sink.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <sstream>

using namespace racebeam;

namespace {

constexpr int kLines = 3 * LogSink::kMaxWaiting;

std::string read_until(int descriptor, const std::string& last) {
  std::string text;
  std::array<char, 4096> part;
  while (text.find(last) == std::string::npos) {
    const ssize_t count = ::read(descriptor, part.data(), part.size());
    if (count <= 0) break;
    text.append(part.data(), static_cast<std::size_t>(count));
  }
  return text;
}

}  // namespace

// A write to a full pipe blocks like one to a hanging disk.
TEST_CASE("A file that hangs does not block threads that log, and lost lines are reported") {
  std::array<int, 2> pipe{};
  REQUIRE(::pipe2(pipe.data(), O_CLOEXEC) == 0);
  ::fcntl(pipe[1], F_SETPIPE_SZ, 4096);
  const auto sink = LogSink::start(pipe[1], OutputKind::kFile,
                                   [](std::int64_t lines) { return "lost " + std::to_string(lines); });
  sink->set_pattern("%v");
  for (int line = 0; line < kLines; ++line) {
    sink->log({{}, "test", spdlog::level::info, "line " + std::to_string(line)});
    sink->flush();
  }
  const std::int64_t losses = sink->lost();
  CHECK(losses > kLines / 3);
  std::istringstream text(read_until(pipe[0], "line " + std::to_string(kLines - 1) + "\n"));
  std::int64_t reported = 0, next = 0, number = 0;
  for (std::string word; text >> word >> number;) {
    if (word == "lost") {
      reported += number;
      next += number;
    } else {
      CHECK(number == next++);
    }
  }
  CHECK(reported == losses);
  CHECK(next == kLines);
  sink->close();
  ::close(pipe[0]);
  ::close(pipe[1]);
}
