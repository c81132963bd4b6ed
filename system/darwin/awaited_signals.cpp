#include "system/program/awaited_signals.hpp"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

namespace racebeam {
namespace {

// The system does not report who has sent a signal. In the foreground of a terminal, a key is a more likely
// source than another process.
bool may_be_from_terminal(int number) {
  if (number != SIGINT && number != SIGQUIT) return false;
  const int terminal = ::open("/dev/tty", O_RDONLY | O_NOCTTY | O_CLOEXEC);
  if (terminal < 0) return false;
  const bool is_in_foreground = ::tcgetpgrp(terminal) == ::getpgrp();
  ::close(terminal);
  return is_in_foreground;
}

}  // namespace

struct AwaitedSignals::Sets {
  // Whether one of the signals comes within this time.
  bool come_within(int milliseconds) const {
    sigset_t pending{};
    for (; ::sigpending(&pending) != 0 || (pending & awaited) == 0; --milliseconds) {
      if (milliseconds <= 0) return false;
      ::usleep(1000);
    }
    return true;
  }

  sigset_t awaited{}, before{};
  struct sigaction before_of_children {};
};

// The system does not deliver a signal that would be ignored, even if it is blocked. So SIGCHLD gets a
// handler, which is never called.
AwaitedSignals::AwaitedSignals(std::span<const int> numbers) : sets_(std::make_unique<Sets>()) {
  sigemptyset(&sets_->awaited);  // it is a macro, so it must not have `::`
  for (const int number : numbers) sigaddset(&sets_->awaited, number);
  ::sigprocmask(SIG_BLOCK, &sets_->awaited, &sets_->before);
  struct sigaction action {};
  action.sa_handler = [](int) {};
  ::sigaction(SIGCHLD, &action, &sets_->before_of_children);
}

AwaitedSignals::~AwaitedSignals() = default;

AwaitedSignals::Signal AwaitedSignals::next(int milliseconds) const {
  if (milliseconds >= 0 && !sets_->come_within(milliseconds)) return {};
  int number = 0;
  if (::sigwait(&sets_->awaited, &number) != 0) return {};
  return {number, may_be_from_terminal(number)};
}

void AwaitedSignals::handle_as_before() const {
  ::sigaction(SIGCHLD, &sets_->before_of_children, nullptr);
  ::sigprocmask(SIG_SETMASK, &sets_->before, nullptr);
}

}  // namespace racebeam
