#include "cli/terminal/tty.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>

namespace racebeam {
namespace {

constexpr std::array kDeadly = {SIGHUP,  SIGINT,  SIGQUIT, SIGTERM, SIGPIPE, SIGALRM, SIGUSR1,
                                SIGUSR2, SIGABRT, SIGSEGV, SIGBUS,  SIGFPE,  SIGILL};
constexpr int kMostWait = 500;  // milliseconds for the last bytes

// What a signal handler needs. A handler has no argument of ours.
struct Before {
  int descriptor = -1;  // of the terminal; -1 if nothing needs to be restored
  termios modes{};
  std::array<char, 128> undo{};  // ends at the end of the array
  std::size_t undo_size = 0;
  std::array<struct sigaction, kDeadly.size() + 1> actions{};  // the last: of SIGTSTP
};
Before saved;

// Calls only what a signal handler may call. Output that is still on its way may end within a sequence: ST
// ends it.
void restore() {
  if (saved.descriptor < 0) return;
  ::tcflush(saved.descriptor, TCOFLUSH);
  const char* next = saved.undo.data() + saved.undo.size() - saved.undo_size;
  const char* const end = saved.undo.data() + saved.undo.size();
  while (next < end) {
    const ssize_t written = ::write(saved.descriptor, next, static_cast<std::size_t>(end - next));
    pollfd state{saved.descriptor, POLLOUT, 0};
    if (written > 0) next += written;
    if (written < 0 && ((errno != EAGAIN && errno != EINTR) || ::poll(&state, 1, kMostWait) <= 0)) break;
  }
  ::tcsetattr(saved.descriptor, TCSAFLUSH, &saved.modes);
}

void restore_and_end(int number) {
  restore();
  ::signal(number, SIG_DFL);
  ::raise(number);
}

void handle_signals() {
  struct sigaction action {};
  action.sa_handler = restore_and_end;
  action.sa_flags = SA_NODEFER;
  for (std::size_t i = 0; i < kDeadly.size(); ++i) {
    ::sigaction(kDeadly[i], &action, &saved.actions[i]);
    if (saved.actions[i].sa_handler == SIG_IGN) ::sigaction(kDeadly[i], &saved.actions[i], nullptr);
  }
  action.sa_handler = SIG_IGN;
  ::sigaction(SIGTSTP, &action, &saved.actions.back());
}

void handle_signals_as_before() {
  for (std::size_t i = 0; i < kDeadly.size(); ++i) ::sigaction(kDeadly[i], &saved.actions[i], nullptr);
  ::sigaction(SIGTSTP, &saved.actions.back(), nullptr);
}

void end() {
  restore();
  handle_signals_as_before();
  ::close(saved.descriptor);
  saved.descriptor = -1;
}

[[noreturn]] void fail(const std::string& what) {
  throw std::runtime_error(what + ": " + std::strerror(errno));
}

}  // namespace

// The descriptor is one of our own: that it does not block must not concern other programs on the terminal.
Tty::Tty() {
  const int descriptor = ::open("/dev/tty", O_RDWR | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (descriptor < 0 || ::tcgetattr(descriptor, &saved.modes) != 0) {
    const int reason = errno;
    if (descriptor >= 0) ::close(descriptor);
    errno = reason;
    fail("cannot draw without a terminal: /dev/tty");
  }
  saved.undo_size = 0;
  saved.descriptor = descriptor;
  handle_signals();
  termios modes = saved.modes;
  modes.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO | IEXTEN);
  modes.c_iflag &= ~static_cast<tcflag_t>(ICRNL | IXON);
  if (::tcsetattr(descriptor, TCSAFLUSH, &modes) == 0) return;
  end();
  throw std::runtime_error("cannot change the modes of /dev/tty");
}

Tty::~Tty() { end(); }

void Tty::change(std::string_view text, std::string_view undo) {
  const std::size_t size = saved.undo_size + undo.size();
  if (size > saved.undo.size()) throw std::logic_error("too much to undo");
  std::copy(undo.begin(), undo.end(), saved.undo.end() - static_cast<std::ptrdiff_t>(size));
  saved.undo_size = size;
  write(text);
}

void Tty::write(std::string_view text) {
  waiting_.append(text);
  flush();
}

void Tty::flush() {
  std::size_t written = 0;
  while (written < waiting_.size()) {
    const ssize_t count = ::write(saved.descriptor, waiting_.data() + written, waiting_.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && errno == EAGAIN) break;
    if (count < 0) fail("cannot write to the terminal");
    written += static_cast<std::size_t>(count);
  }
  waiting_.erase(0, written);
}

std::string Tty::wait(Time until, bool writes_too) {
  std::array<char, 4096> bytes{};
  while (true) {
    const auto remaining =
        std::chrono::ceil<std::chrono::milliseconds>(until - std::chrono::steady_clock::now());
    const bool writes = !waiting_.empty();
    pollfd state{saved.descriptor, static_cast<short>(writes ? POLLIN | POLLOUT : POLLIN), 0};
    const int ready = ::poll(&state, 1, static_cast<int>(std::max<std::int64_t>(0, remaining.count())));
    if (ready < 0 && errno != EINTR) fail("cannot wait for the terminal");
    if (ready == 0) return {};
    if (ready < 0) continue;
    if ((state.revents & (POLLHUP | POLLERR | POLLNVAL)) != 0)
      throw std::runtime_error("the terminal is gone");
    if ((state.revents & POLLOUT) != 0) flush();
    const ssize_t count =
        (state.revents & POLLIN) != 0 ? ::read(saved.descriptor, bytes.data(), bytes.size()) : 0;
    if (count > 0) return {bytes.data(), static_cast<std::size_t>(count)};
    if (writes_too && writes && waiting_.empty()) return {};
  }
}

Room Tty::room() const {
  Room room;
  winsize size{};
  if (::ioctl(saved.descriptor, TIOCGWINSZ, &size) != 0 || size.ws_col == 0 || size.ws_row == 0) return room;
  room.columns = size.ws_col;
  room.rows = size.ws_row;
  if (size.ws_xpixel >= size.ws_col && size.ws_ypixel >= size.ws_row) {
    room.cell_width = size.ws_xpixel / size.ws_col;
    room.cell_height = size.ws_ypixel / size.ws_row;
  }
  return room;
}

}  // namespace racebeam
