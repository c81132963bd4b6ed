#include "system/program/standard_streams.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>

#include "system/program/without_waiting.hpp"

namespace racebeam {

void prepare_standard_streams() {
  constexpr std::array kWays = {O_WRONLY, O_RDONLY, O_RDONLY};
  for (int stream = 0; stream < 3; ++stream) {
    if (::fcntl(stream, F_GETFD) == -1) ::open("/dev/null", kWays.at(static_cast<std::size_t>(stream)));
  }
}

bool is_terminal(int stream) { return ::isatty(stream) != 0; }

int terminal_columns(int stream) {
  constexpr int kUsual = 80;
  if (!is_terminal(stream)) return 0;
  winsize size{};
  return ::ioctl(stream, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kUsual;
}

OutputKind kind_of_output(int stream) {
  struct stat found {};
  if (::fstat(stream, &found) != 0) return OutputKind::kOther;
  return S_ISREG(found.st_mode)    ? OutputKind::kFile
         : S_ISSOCK(found.st_mode) ? OutputKind::kSocket
                                   : OutputKind::kOther;
}

// A pipe or a terminal that has room accepts a line of up to a page, unless another process writes there,
// too.
bool has_room(int stream) {
  pollfd state{stream, POLLOUT, 0};
  return ::poll(&state, 1, 0) > 0;
}

std::ptrdiff_t write_some(int stream, OutputKind kind, std::string_view bytes) {
  if (kind == OutputKind::kSocket)
    return ::send(stream, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  if (kind == OutputKind::kOther) {
    const std::ptrdiff_t count = write_without_waiting(stream, bytes);
    if (count >= 0 || (errno != EOPNOTSUPP && errno != EINVAL && errno != ENOSYS)) return count;
  }
  return ::write(stream, bytes.data(), bytes.size());
}

bool may_be_repeated(int error) { return error == EAGAIN || error == EINTR; }

}  // namespace racebeam
