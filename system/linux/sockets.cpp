#include "system/program/sockets.hpp"

#include <linux/inet_diag.h>
#include <linux/netlink.h>
#include <linux/sock_diag.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <optional>

namespace racebeam {
namespace {

int number_of(SocketNumber socket) { return static_cast<int>(socket); }

struct Place {
  std::array<std::uint32_t, 4> address{};
  std::uint16_t port = 0;
  int family = AF_UNSPEC;
};

// `ask` is getsockname or getpeername. Numbers are in network byte order.
template <typename Ask>
std::optional<Place> place_of(int descriptor, Ask ask) {
  sockaddr_storage found{};
  socklen_t size = sizeof found;
  if (ask(descriptor, reinterpret_cast<sockaddr*>(&found), &size) != 0) return std::nullopt;
  Place place;
  place.family = found.ss_family;
  if (place.family == AF_INET) {
    const auto& four = reinterpret_cast<const sockaddr_in&>(found);
    place.port = four.sin_port;
    place.address[0] = four.sin_addr.s_addr;
    return place;
  }
  if (place.family != AF_INET6) return std::nullopt;
  const auto& six = reinterpret_cast<const sockaddr_in6&>(found);
  place.port = six.sin6_port;
  std::memcpy(place.address.data(), &six.sin6_addr, sizeof six.sin6_addr);
  return place;
}

struct Question {
  nlmsghdr header{};
  inet_diag_req_v2 socket{};
};

// A question about the socket whose connection leads from `from` to `to`.
Question question(const Place& from, const Place& to) {
  Question question;
  question.header.nlmsg_len = sizeof question;
  question.header.nlmsg_type = SOCK_DIAG_BY_FAMILY;
  question.header.nlmsg_flags = NLM_F_REQUEST;
  question.socket.sdiag_family = static_cast<__u8>(from.family);
  question.socket.sdiag_protocol = IPPROTO_TCP;
  question.socket.idiag_states = ~0U;
  inet_diag_sockid& id = question.socket.id;
  id.idiag_sport = from.port;
  id.idiag_dport = to.port;
  std::memcpy(id.idiag_src, from.address.data(), sizeof id.idiag_src);
  std::memcpy(id.idiag_dst, to.address.data(), sizeof id.idiag_dst);
  for (__u32& part : id.idiag_cookie) part = INET_DIAG_NOCOOKIE;
  return question;
}

struct Answer {
  nlmsghdr header{};
  inet_diag_msg socket{};
  std::array<char, 4096> more{};
};

// The inode of the socket; 0 if no process has the socket open. Nothing if the socket does not exist.
std::optional<std::uint32_t> inode(const Question& question) {
  const int link = ::socket(AF_NETLINK, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, NETLINK_SOCK_DIAG);
  if (link < 0) return std::nullopt;
  Answer found;
  const bool answered =
      ::send(link, &question, sizeof question, 0) == static_cast<ssize_t>(sizeof question) &&
      ::recv(link, &found, sizeof found, 0) >=
          static_cast<ssize_t>(sizeof found.header + sizeof found.socket);
  ::close(link);
  if (!answered || found.header.nlmsg_type != SOCK_DIAG_BY_FAMILY) return std::nullopt;
  return found.socket.idiag_inode;
}

}  // namespace

bool has_local_channels() { return true; }
std::size_t longest_socket_path() { return sizeof(sockaddr_un::sun_path) - 1; }

void claim_address(SocketNumber socket) {
  constexpr int kOn = 1;
  ::setsockopt(number_of(socket), SOL_SOCKET, SO_REUSEADDR, &kOn, sizeof kOn);
}

void close_socket(SocketNumber socket) { ::close(number_of(socket)); }

// Fails on a Unix socket. The option must be set each time.
void acknowledge_at_once(SocketNumber socket) {
  constexpr int kOn = 1;
  ::setsockopt(number_of(socket), IPPROTO_TCP, TCP_QUICKACK, &kOn, sizeof kOn);
}

PeerState state_of_peer(SocketNumber socket) {
  pollfd state{number_of(socket), POLLRDHUP, 0};
  if (::poll(&state, 1, 0) <= 0) return PeerState::kThere;
  if ((state.revents & (POLLHUP | POLLERR)) != 0) return PeerState::kGone;
  return (state.revents & POLLRDHUP) != 0 ? PeerState::kHalfClosed : PeerState::kThere;
}

bool peer_has_closed(SocketNumber socket) {
  const int descriptor = number_of(socket);
  const auto here = place_of(descriptor, ::getsockname), there = place_of(descriptor, ::getpeername);
  return here && there && inode(question(*there, *here)) == 0U;
}

// Fails on a Unix socket, where the system reports directly that the other end has gone.
void probe_often(SocketNumber socket) {
  constexpr int kBetweenProbes = 5;  // seconds
  for (const int option : {TCP_KEEPIDLE, TCP_KEEPINTVL})
    ::setsockopt(number_of(socket), IPPROTO_TCP, option, &kBetweenProbes, sizeof kBetweenProbes);
}

#if defined(SO_PEERCRED)
std::string user_of_peer(SocketNumber socket) {
  ucred peer{};
  socklen_t size = sizeof peer;
  if (::getsockopt(number_of(socket), SOL_SOCKET, SO_PEERCRED, &peer, &size) != 0) return {};
  return "user " + std::to_string(peer.uid);
}
#else
std::string user_of_peer(SocketNumber) { return "a user"; }
#endif

}  // namespace racebeam
