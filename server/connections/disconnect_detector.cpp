#include "server/connections/disconnect_detector.hpp"

#include "system/program/sockets.hpp"

namespace racebeam {

using namespace std::chrono_literals;

constexpr auto kBetweenQuestions = 200ms;

bool DisconnectDetector::has_gone(Socket& socket) {
  if (!socket.is_open()) return true;  // the server has closed it
  const auto number = static_cast<SocketNumber>(socket.native_handle());
  const PeerState state = state_of_peer(number);
  if (state == PeerState::kGone) return true;
  const auto now = Clock::now();
  if (state == PeerState::kThere || now - looked_ < kBetweenQuestions) return false;
  looked_ = now;
  if (!std::exchange(half_closed_, true)) probe_often(number);
  return peer_has_closed(number);
}

}  // namespace racebeam
