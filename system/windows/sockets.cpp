#include "system/program/sockets.hpp"

#include <winsock2.h>

#include <mstcpip.h>

namespace racebeam {
namespace {

SOCKET number_of(SocketNumber socket) { return static_cast<SOCKET>(socket); }

}  // namespace

bool has_local_channels() { return false; }
std::size_t longest_socket_path() { return 0; }

// With SO_REUSEADDR, Windows would let two sockets listen at one address.
void claim_address(SocketNumber socket) {
  constexpr DWORD kOn = 1;
  setsockopt(number_of(socket), SOL_SOCKET, SO_EXCLUSIVEADDRUSE, reinterpret_cast<const char*>(&kOn),
             sizeof kOn);
}

void close_socket(SocketNumber socket) { closesocket(number_of(socket)); }
void acknowledge_at_once(SocketNumber) {}

// Bytes that have not been read hide the end of the stream behind them.
PeerState state_of_peer(SocketNumber socket) {
  char next = 0;
  const int count = recv(number_of(socket), &next, 1, MSG_PEEK);
  if (count > 0) return PeerState::kThere;
  if (count == 0) return PeerState::kHalfClosed;
  return WSAGetLastError() == WSAEWOULDBLOCK ? PeerState::kThere : PeerState::kGone;
}

bool peer_has_closed(SocketNumber) { return false; }

void probe_often(SocketNumber socket) {
  tcp_keepalive often{1, 5'000, 5'000};  // milliseconds
  DWORD none = 0;
  WSAIoctl(number_of(socket), SIO_KEEPALIVE_VALS, &often, sizeof often, nullptr, 0, &none, nullptr, nullptr);
}

std::string user_of_peer(SocketNumber) { return {}; }

}  // namespace racebeam
