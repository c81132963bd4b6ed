#include "system/program/standard_streams.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <cerrno>
#include <string>

#include "tests/games/scratch.hpp"

using namespace racebeam;

namespace {

// Two ends, of which the first one is read.
struct Ends {
  explicit Ends(bool socket) {
    REQUIRE((socket ? ::socketpair(AF_UNIX, SOCK_STREAM, 0, both.data()) : ::pipe(both.data())) == 0);
  }
  ~Ends() {
    close_reader();
    ::close(both[1]);
  }
  Ends(const Ends&) = delete;
  Ends& operator=(const Ends&) = delete;

  void close_reader() {
    if (both[0] >= 0) ::close(both[0]);
    both[0] = -1;
  }

  std::array<int, 2> both{};
};

}  // namespace

TEST_CASE("A destination is a file, a socket or another one") {
  const Scratch folder;
  const int file = ::open(folder.write("file", "").c_str(), O_WRONLY | O_CLOEXEC);
  CHECK(kind_of_output(file) == OutputKind::kFile);
  ::close(file);
  CHECK(kind_of_output(file) == OutputKind::kOther);
  CHECK(kind_of_output(Ends(true).both[1]) == OutputKind::kSocket);
  CHECK(kind_of_output(Ends(false).both[1]) == OutputKind::kOther);
}

TEST_CASE("A pipe or a socket takes what there is room for, without waiting") {
  const bool socket = GENERATE(false, true);
  const Ends ends(socket);
  const OutputKind kind = kind_of_output(ends.both[1]);
  CHECK(has_room(ends.both[1]));
  const std::string much(1 << 16, 'x');
  std::ptrdiff_t written = 0, last = 0;
  while ((last = write_some(ends.both[1], kind, much)) > 0) written += last;
  CHECK(last == -1);
  CHECK(may_be_repeated(errno));
  CHECK_FALSE(has_room(ends.both[1]));
  std::string read(static_cast<std::size_t>(written) + 1, '\0');
  std::size_t size = 0;
  while (size < static_cast<std::size_t>(written))
    size += static_cast<std::size_t>(::read(ends.both[0], read.data() + size, read.size() - size));
  CHECK(size == static_cast<std::size_t>(written));
  CHECK(has_room(ends.both[1]));
}

TEST_CASE("A write to a socket whose other end has gone fails without a signal") {
  Ends ends(true);
  ends.close_reader();
  CHECK(write_some(ends.both[1], OutputKind::kSocket, "x") == -1);
  CHECK_FALSE(may_be_repeated(errno));
}

TEST_CASE("All of a short text goes into a file") {
  const Scratch folder;
  const int file = ::open(folder.write("file", "").c_str(), O_RDWR | O_CLOEXEC);
  CHECK(write_some(file, OutputKind::kFile, "text") == 4);
  std::string read(5, '\0');
  CHECK(::pread(file, read.data(), read.size(), 0) == 4);
  CHECK(read.substr(0, 4) == "text");
  ::close(file);
}

TEST_CASE("A write that lacked room, or was interrupted, may be repeated") {
  CHECK(may_be_repeated(EAGAIN));
  CHECK(may_be_repeated(EINTR));
  CHECK_FALSE(may_be_repeated(EPIPE));
  CHECK_FALSE(may_be_repeated(EBADF));
}

TEST_CASE("A terminal has a width, which is 80 if it is unknown, and a pipe does not") {
  const int terminal = ::posix_openpt(O_RDWR | O_NOCTTY);
  REQUIRE(terminal >= 0);
  REQUIRE((::grantpt(terminal) == 0 && ::unlockpt(terminal) == 0));
  const int shown = ::open(::ptsname(terminal), O_RDWR | O_NOCTTY | O_CLOEXEC);
  REQUIRE(shown >= 0);
  CHECK(is_terminal(shown));
  CHECK(terminal_columns(shown) == 80);
  const winsize size{.ws_row = 24, .ws_col = 132, .ws_xpixel = 0, .ws_ypixel = 0};
  REQUIRE(::ioctl(shown, TIOCSWINSZ, &size) == 0);
  CHECK(terminal_columns(shown) == 132);
  ::close(shown);
  ::close(terminal);
  const Ends ends(false);
  CHECK_FALSE(is_terminal(ends.both[1]));
  CHECK(terminal_columns(ends.both[1]) == 0);
}
