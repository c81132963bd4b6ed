#include "server/connections/departure.hpp"

#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include "server/connections/peer_socket.hpp"

namespace racebeam {
namespace {

using namespace std::chrono_literals;

constexpr auto kBetweenQuestions = 200ms;
constexpr int kBetweenProbes = 5;  // seconds

// Fails on a Unix socket, whose other end is seen directly.
void probe_often(int descriptor) {
  for (const int option : {TCP_KEEPIDLE, TCP_KEEPINTVL})
    ::setsockopt(descriptor, IPPROTO_TCP, option, &kBetweenProbes, sizeof kBetweenProbes);
}

}  // namespace

bool Departure::has_gone(Socket& socket) {
  if (!socket.is_open()) return true;  // the server has closed it
  const int descriptor = socket.native_handle();
  pollfd state{descriptor, POLLRDHUP, 0};
  if (::poll(&state, 1, 0) <= 0) return false;
  if ((state.revents & (POLLHUP | POLLERR)) != 0) return true;
  const auto now = Clock::now();
  if ((state.revents & POLLRDHUP) == 0 || now - looked_ < kBetweenQuestions) return false;
  looked_ = now;
  if (!std::exchange(half_closed_, true)) probe_often(descriptor);
  return peer_has_closed(descriptor);
}

}  // namespace racebeam
