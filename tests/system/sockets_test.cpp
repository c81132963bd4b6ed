#include "system/program/sockets.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <chrono>
#include <string>
#include <thread>

using namespace racebeam;
using namespace std::chrono_literals;

namespace {

sockaddr_in loopback(std::uint16_t port = 0) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

int option_of(int socket, int level, int name) {
  int value = -1;
  socklen_t size = sizeof value;
  REQUIRE(::getsockopt(socket, level, name, &value, &size) == 0);
  return value;
}

// A connection on this machine.
struct Tcp {
  Tcp() {
    sockaddr_in address = loopback();
    socklen_t size = sizeof address;
    auto* const place = reinterpret_cast<sockaddr*>(&address);
    const int listener = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    REQUIRE((::bind(listener, place, size) == 0 && ::listen(listener, 1) == 0));
    REQUIRE(::getsockname(listener, place, &size) == 0);
    there = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    REQUIRE(::connect(there, place, size) == 0);
    here = ::accept(listener, nullptr, nullptr);
    REQUIRE(here >= 0);
    ::close(listener);
  }
  ~Tcp() {
    ::close(here);
    close_there();
  }
  Tcp(const Tcp&) = delete;
  Tcp& operator=(const Tcp&) = delete;

  void close_there() {
    if (there >= 0) close_socket(there);
    there = -1;
  }

  int here = -1, there = -1;
};

// The network of this machine delivers within a moment.
PeerState state_soon(int socket, PeerState expected) {
  for (int i = 0; i < 1000 && state_of_peer(socket) != expected; ++i) std::this_thread::sleep_for(1ms);
  return state_of_peer(socket);
}

}  // namespace

TEST_CASE("The other end is there, has closed its sending end, or has gone") {
  std::array<int, 2> ends{};
  REQUIRE(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()) == 0);
  CHECK(state_of_peer(ends[0]) == PeerState::kThere);
  REQUIRE(::write(ends[1], "x", 1) == 1);
  CHECK(state_of_peer(ends[0]) == PeerState::kThere);
  REQUIRE(::shutdown(ends[1], SHUT_WR) == 0);
  CHECK(state_of_peer(ends[0]) == PeerState::kHalfClosed);
  ::close(ends[1]);
  CHECK(state_of_peer(ends[0]) == PeerState::kGone);
  ::close(ends[0]);
}

TEST_CASE("An end of TCP that is closed looks half closed, and is known to be closed") {
  Tcp open, half, closed;
  CHECK(state_of_peer(open.here) == PeerState::kThere);
  CHECK_FALSE(peer_has_closed(open.here));
  REQUIRE(::shutdown(half.there, SHUT_WR) == 0);
  CHECK(state_soon(half.here, PeerState::kHalfClosed) == PeerState::kHalfClosed);
  CHECK_FALSE(peer_has_closed(half.here));
  closed.close_there();
  CHECK(state_soon(closed.here, PeerState::kHalfClosed) == PeerState::kHalfClosed);
  CHECK(peer_has_closed(closed.here));
}

TEST_CASE("A socket that is not of TCP, or has no other end, is not known to be closed") {
  std::array<int, 2> ends{};
  REQUIRE(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()) == 0);
  ::close(ends[1]);
  CHECK_FALSE(peer_has_closed(ends[0]));
  ::close(ends[0]);
  const int lonely = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  CHECK_FALSE(peer_has_closed(lonely));
  ::close(lonely);
}

TEST_CASE("TCP asks every five seconds whether the other end is there") {
  const Tcp tcp;
  probe_often(tcp.here);
  CHECK(option_of(tcp.here, IPPROTO_TCP, TCP_KEEPIDLE) == 5);
  CHECK(option_of(tcp.here, IPPROTO_TCP, TCP_KEEPINTVL) == 5);
}

TEST_CASE("An address that was claimed is free although a connection has just ended there") {
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  CHECK(option_of(socket, SOL_SOCKET, SO_REUSEADDR) == 0);
  claim_address(socket);
  CHECK(option_of(socket, SOL_SOCKET, SO_REUSEADDR) == 1);
  ::close(socket);
}

TEST_CASE("The user at the other end of a Unix socket is known") {
  std::array<int, 2> ends{};
  REQUIRE(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()) == 0);
  CHECK(user_of_peer(ends[0]) == "user " + std::to_string(::geteuid()));
  for (const int end : ends) ::close(end);
  CHECK(user_of_peer(ends[0]).empty());
}
