#include "system/program/tty.hpp"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/select.h>
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
constexpr int kMaxWait = 500;  // milliseconds for the last bytes

// What a signal handler needs. A handler has no argument of ours.
struct Before {
  int descriptor = -1;  // of the terminal; -1 if nothing needs to be restored
  termios modes{};
  std::array<char, 128> undo{};  // ends at the end of the array
  std::size_t undo_size = 0;
  std::array<struct sigaction, kDeadly.size() + 1> actions{};  // the last: of SIGTSTP
};
Before saved;

struct Ready {
  bool to_read = false, to_write = false;
};

// Waits until the terminal is ready for what is asked, or the time is over. Returns what select() does. On
// macOS, poll() refuses /dev/tty.
int wait_for(Ready& ready, int milliseconds) {
  const int descriptor = saved.descriptor;
  fd_set reading, writing;
  FD_ZERO(&reading);
  FD_ZERO(&writing);
  if (ready.to_read) FD_SET(descriptor, &reading);
  if (ready.to_write) FD_SET(descriptor, &writing);
  timeval limit{.tv_sec = milliseconds / 1000, .tv_usec = milliseconds % 1000 * 1000};
  const int count = ::select(descriptor + 1, &reading, &writing, nullptr, &limit);
  ready = {count > 0 && FD_ISSET(descriptor, &reading), count > 0 && FD_ISSET(descriptor, &writing)};
  return count;
}

// Calls only what a signal handler may call. Output that is still on its way may end within a sequence: ST
// ends it.
void restore() {
  if (saved.descriptor < 0) return;
  ::tcflush(saved.descriptor, TCOFLUSH);
  const char* next = saved.undo.data() + saved.undo.size() - saved.undo_size;
  const char* const end = saved.undo.data() + saved.undo.size();
  while (next < end) {
    const ssize_t written = ::write(saved.descriptor, next, static_cast<std::size_t>(end - next));
    Ready room{.to_write = true};
    if (written > 0) next += written;
    if (written < 0 && ((errno != EAGAIN && errno != EINTR) || wait_for(room, kMaxWait) <= 0)) break;
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
  const bool is_too_high = descriptor >= FD_SETSIZE;
  if (descriptor < 0 || is_too_high || ::tcgetattr(descriptor, &saved.modes) != 0) {
    const int reason = is_too_high ? EMFILE : errno;
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
  while (true) {
    const auto remaining =
        std::chrono::ceil<std::chrono::milliseconds>(until - std::chrono::steady_clock::now());
    const bool writes = !waiting_.empty();
    Ready ready{.to_read = true, .to_write = writes};
    const int count = wait_for(ready, static_cast<int>(std::max<std::int64_t>(0, remaining.count())));
    if (count < 0 && errno != EINTR) fail("cannot wait for the terminal");
    if (count == 0) return {};
    std::string bytes = ready.to_read ? read() : "";
    if (ready.to_write) flush();
    if (!bytes.empty() || (writes_too && writes && waiting_.empty())) return bytes;
  }
}

// A terminal that is gone has no bytes, though it is ready.
std::string Tty::read() {
  std::array<char, 4096> bytes{};
  const ssize_t count = ::read(saved.descriptor, bytes.data(), bytes.size());
  if (count > 0) return {bytes.data(), static_cast<std::size_t>(count)};
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return {};
  throw std::runtime_error("the terminal is gone");
}

TerminalSize Tty::size() const {
  TerminalSize size;
  winsize found{};
  if (::ioctl(saved.descriptor, TIOCGWINSZ, &found) != 0 || found.ws_col == 0 || found.ws_row == 0)
    return size;
  size.columns = found.ws_col;
  size.rows = found.ws_row;
  if (found.ws_xpixel >= found.ws_col && found.ws_ypixel >= found.ws_row) {
    size.cell_width = found.ws_xpixel / found.ws_col;
    size.cell_height = found.ws_ypixel / found.ws_row;
  }
  return size;
}

}  // namespace racebeam
