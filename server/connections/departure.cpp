#include "server/connections/departure.hpp"

#include <poll.h>
#include <sys/socket.h>

namespace racebeam {
namespace {

using namespace std::chrono_literals;

constexpr auto kBetweenProbes = 200ms;

bool is_unix(int descriptor) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  return ::getsockname(descriptor, reinterpret_cast<sockaddr*>(&address), &size) == 0 &&
         address.ss_family == AF_UNIX;
}

}  // namespace

bool Departure::has_gone(Socket& socket) {
  if (!socket.is_open()) return true;  // the server has closed it
  const int descriptor = socket.native_handle();
  pollfd state{descriptor, POLLRDHUP, 0};
  if (::poll(&state, 1, 0) <= 0) return false;
  if ((state.revents & (POLLHUP | POLLERR)) != 0) return true;
  const auto now = Clock::now();
  if ((state.revents & POLLRDHUP) != 0 && now - probed_ > kBetweenProbes && !is_unix(descriptor)) {
    probed_ = now;
    ::send(descriptor, " ", 1, MSG_OOB | MSG_DONTWAIT | MSG_NOSIGNAL);
  }
  return false;
}

}  // namespace racebeam
