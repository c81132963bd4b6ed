#include "system/program/activation.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <cstddef>
#include <cstring>
#include <stdexcept>

#include "tests/games/scratch.hpp"

using namespace racebeam;
using Catch::Matchers::Message;

namespace {

// The variables of a manager, until the test ends.
struct Variables {
  Variables(const std::string& process, const std::string& count, const char* names = nullptr) {
    ::setenv("LISTEN_PID", process.c_str(), 1);
    ::setenv("LISTEN_FDS", count.c_str(), 1);
    if (names != nullptr) ::setenv("LISTEN_FDNAMES", names, 1);
  }
  ~Variables() {
    for (const char* const name : {"LISTEN_PID", "LISTEN_FDS", "LISTEN_FDNAMES"}) ::unsetenv(name);
  }
  Variables(const Variables&) = delete;
  Variables& operator=(const Variables&) = delete;
};

std::string own_number() { return std::to_string(::getpid()); }

int unix_socket(int kind) { return ::socket(AF_UNIX, kind | SOCK_CLOEXEC, 0); }

// Binds a socket to a path, or to an abstract name that begins with '@'.
void bind_to(int socket, const std::string& name) {
  sockaddr_un address{AF_UNIX, {}};
  std::memcpy(address.sun_path, name.data(), name.size());
  if (name.front() == '@') address.sun_path[0] = '\0';
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size());
  REQUIRE(::bind(socket, reinterpret_cast<const sockaddr*>(&address), size) == 0);
}

// The descriptors 3 and 4 are two sockets; what they were before comes back.
class Passed {
 public:
  explicit Passed(const std::array<int, 2>& sockets) {
    for (std::size_t i = 0; i < 2; ++i) {
      const int number = 3 + static_cast<int>(i);
      before_[i] = ::fcntl(number, F_DUPFD_CLOEXEC, 10);
      REQUIRE(::dup2(sockets[i], number) == number);
    }
  }
  ~Passed() {
    for (std::size_t i = 0; i < 2; ++i) {
      const int number = 3 + static_cast<int>(i);
      before_[i] >= 0 ? ::dup2(before_[i], number) : ::close(number);
      if (before_[i] >= 0) ::close(before_[i]);
    }
  }
  Passed(const Passed&) = delete;
  Passed& operator=(const Passed&) = delete;

 private:
  std::array<int, 2> before_{};
};

// A socket with a number that the others do not take.
int high(int socket) {
  const int number = ::fcntl(socket, F_DUPFD_CLOEXEC, 20);
  ::close(socket);
  return number;
}

}  // namespace

TEST_CASE("Without variables for this process, no sockets are inherited") {
  CHECK(inherited_sockets().empty());
  {
    const Variables other(std::to_string(::getppid()), "1000000");
    CHECK(inherited_sockets().empty());
  }
  const Variables none(own_number(), "0");
  CHECK(inherited_sockets().empty());
  ::unsetenv("LISTEN_FDS");
  CHECK(inherited_sockets().empty());
}

TEST_CASE("Invalid numbers of a manager are refused") {
  const auto refusal = [](const std::string& process, const std::string& count) {
    const Variables variables(process, count);
    try {
      inherited_sockets();
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(refusal("x", "1") == "LISTEN_PID is 'x', which is not a number");
  CHECK(refusal(own_number(), "1x") == "LISTEN_FDS is '1x', which is not a number");
  CHECK(refusal(own_number(), "") == "LISTEN_FDS is '', which is not a number");
  CHECK(refusal(own_number(), "-1") == "LISTEN_FDS is -1; it must be 0 to 1000");
  CHECK(refusal(own_number(), "1001") == "LISTEN_FDS is 1001; it must be 0 to 1000");
}

TEST_CASE("Sockets that listen are inherited, with the names that the manager gives them") {
  const Scratch folder;
  const int first = high(unix_socket(SOCK_STREAM)), second = high(unix_socket(SOCK_STREAM));
  bind_to(first, folder.path("first"));
  bind_to(second, folder.path("second"));
  REQUIRE((::listen(first, 1) == 0 && ::listen(second, 1) == 0));
  {
    const Passed passed({first, second});
    const Variables variables(own_number(), "2", "one");
    const std::vector<InheritedSocket> found = inherited_sockets();
    REQUIRE(found.size() == 2);
    CHECK((found[0].descriptor == 3 && found[0].name == "one"));
    CHECK((found[1].descriptor == 4 && found[1].name == "unknown"));
    for (const InheritedSocket& socket : found)
      CHECK((::fcntl(socket.descriptor, F_GETFD) & FD_CLOEXEC) != 0);
    ::setenv("LISTEN_FDNAMES", "one:two:three", 1);
    CHECK(inherited_sockets().at(1).name == "two");
  }
  for (const int socket : {first, second}) ::close(socket);
}

TEST_CASE("A socket that does not listen is refused by its number") {
  const Scratch folder;
  const int listens = high(unix_socket(SOCK_STREAM)), other = high(unix_socket(SOCK_STREAM));
  bind_to(listens, folder.path("first"));
  REQUIRE(::listen(listens, 1) == 0);
  {
    const Passed passed({listens, other});
    const Variables variables(own_number(), "2");
    CHECK_THROWS_MATCHES(
        inherited_sockets(), std::runtime_error,
        Message("descriptor 4 of LISTEN_FDS is not a socket that listens (Accept=no in the unit)"));
  }
  for (const int socket : {listens, other}) ::close(socket);
}

TEST_CASE("A state is sent to the manager, at a path or at an abstract name") {
  const Scratch folder;
  for (const std::string& name : {folder.path("manager"), "@racebeam-test-" + own_number()}) {
    const int manager = unix_socket(SOCK_DGRAM | SOCK_NONBLOCK);
    bind_to(manager, name);
    ::setenv("NOTIFY_SOCKET", name.c_str(), 1);
    notify_manager("READY=1");
    ::unsetenv("NOTIFY_SOCKET");
    std::array<char, 100> text{};
    INFO(name);
    CHECK(::recv(manager, text.data(), text.size(), 0) == 7);
    CHECK(std::string(text.data()) == "READY=1");
    ::close(manager);
  }
}

TEST_CASE("A manager that does not listen, or that nobody named, changes nothing") {
  const Scratch folder;
  for (const std::string& name : {std::string(), folder.path("nobody"), std::string(1000, 'x')}) {
    ::setenv("NOTIFY_SOCKET", name.c_str(), 1);
    CHECK_NOTHROW(notify_manager("READY=1"));
  }
  ::unsetenv("NOTIFY_SOCKET");
  CHECK_NOTHROW(notify_manager("READY=1"));
}
