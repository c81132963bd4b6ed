#include "system/program/without_waiting.hpp"

#include <fcntl.h>
#include <sys/uio.h>

namespace racebeam {

std::ptrdiff_t read_without_waiting(int descriptor, std::span<char> space) {
  iovec part{space.data(), space.size()};
  return ::preadv2(descriptor, &part, 1, -1, RWF_NOWAIT);
}

std::ptrdiff_t write_without_waiting(int descriptor, std::string_view bytes) {
  iovec part{const_cast<char*>(bytes.data()), bytes.size()};
  return ::pwritev2(descriptor, &part, 1, -1, RWF_NOWAIT);
}

void make_room(int pipe) {
  constexpr int kRoom = 1 << 18;  // bytes; a pipe holds 64 KiB by default
  if (::fcntl(pipe, F_GETPIPE_SZ) < kRoom) ::fcntl(pipe, F_SETPIPE_SZ, kRoom);
}

}  // namespace racebeam
