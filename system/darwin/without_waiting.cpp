#include "system/program/without_waiting.hpp"

#include <limits.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace racebeam {
namespace {

// Whether the descriptor is ready. If not, errno has the reason. For some devices, the system cannot tell.
bool is_ready(int descriptor, short direction) {
  pollfd state{descriptor, direction, 0};
  const int count = ::poll(&state, 1, 0);
  if (count < 0) return false;
  errno = count == 0 ? EAGAIN : EOPNOTSUPP;
  return count > 0 && (state.revents & POLLNVAL) == 0;
}

}  // namespace

// It waits after all if another process takes the bytes in between.
std::ptrdiff_t read_without_waiting(int descriptor, std::span<char> space) {
  return is_ready(descriptor, POLLIN) ? ::read(descriptor, space.data(), space.size()) : -1;
}

// A pipe that is ready takes PIPE_BUF bytes without waiting.
std::ptrdiff_t write_without_waiting(int descriptor, std::string_view bytes) {
  const std::size_t most = std::min<std::size_t>(bytes.size(), PIPE_BUF);
  return is_ready(descriptor, POLLOUT) ? ::write(descriptor, bytes.data(), most) : -1;
}

void make_room(int) {}  // a pipe grows by itself, to 64 KiB at most

}  // namespace racebeam
