#include "system/program/sockets.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/event.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstddef>

namespace racebeam {
namespace {

int number_of(SocketNumber socket) { return static_cast<int>(socket); }

void set_option(SocketNumber socket, int level, int option, int value) {
  ::setsockopt(number_of(socket), level, option, &value, sizeof value);
}

}  // namespace

bool has_local_channels() { return true; }
std::size_t longest_socket_path() { return sizeof(sockaddr_un::sun_path) - 1; }
void claim_address(SocketNumber socket) { set_option(socket, SOL_SOCKET, SO_REUSEADDR, 1); }
void close_socket(SocketNumber socket) { ::close(number_of(socket)); }
void acknowledge_at_once(SocketNumber) {}

// poll() does not have an event for a half-closed socket; kevent() distinguishes the two directions.
PeerState state_of_peer(SocketNumber socket) {
  const int queue = ::kqueue();
  if (queue < 0) return PeerState::kThere;
  const auto number = static_cast<std::uintptr_t>(socket);
  std::array<struct kevent, 2> events{};
  EV_SET(&events[0], number, EVFILT_READ, EV_ADD, 0, 0, nullptr);
  EV_SET(&events[1], number, EVFILT_WRITE, EV_ADD, 0, 0, nullptr);
  constexpr timespec kAtOnce{};
  const int count = ::kevent(queue, events.data(), events.size(), events.data(), events.size(), &kAtOnce);
  ::close(queue);
  auto state = PeerState::kThere;
  for (int i = 0; i < count; ++i) {
    const struct kevent& event = events.at(static_cast<std::size_t>(i));
    if ((event.flags & EV_EOF) == 0) continue;
    if (event.filter == EVFILT_WRITE) return PeerState::kGone;
    state = PeerState::kHalfClosed;
  }
  return state;
}

bool peer_has_closed(SocketNumber) { return false; }

// Fails on a Unix socket, where the system reports directly that the other end has gone.
void probe_often(SocketNumber socket) {
  constexpr int kBetweenProbes = 5;  // seconds
  for (const int option : {TCP_KEEPALIVE, TCP_KEEPINTVL})
    set_option(socket, IPPROTO_TCP, option, kBetweenProbes);
}

std::string user_of_peer(SocketNumber socket) {
  uid_t user = 0;
  gid_t group = 0;
  if (::getpeereid(number_of(socket), &user, &group) != 0) return {};
  return "user " + std::to_string(user);
}

}  // namespace racebeam
