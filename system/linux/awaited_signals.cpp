#include "system/program/awaited_signals.hpp"

#include <signal.h>

#include <ctime>

namespace racebeam {

struct AwaitedSignals::Sets {
  sigset_t awaited{}, before{};
};

AwaitedSignals::AwaitedSignals(std::span<const int> numbers) : sets_(std::make_unique<Sets>()) {
  ::sigemptyset(&sets_->awaited);
  for (const int number : numbers) ::sigaddset(&sets_->awaited, number);
  ::sigprocmask(SIG_BLOCK, &sets_->awaited, &sets_->before);
}

AwaitedSignals::~AwaitedSignals() = default;

AwaitedSignals::Signal AwaitedSignals::next(int milliseconds) const {
  siginfo_t signal{};
  const timespec limit{0, milliseconds * 1'000'000L};
  const int number = milliseconds < 0 ? ::sigwaitinfo(&sets_->awaited, &signal)
                                      : ::sigtimedwait(&sets_->awaited, &signal, &limit);
  if (number <= 0) return {};
  return {number, signal.si_code == SI_KERNEL};
}

void AwaitedSignals::handle_as_before() const { ::sigprocmask(SIG_SETMASK, &sets_->before, nullptr); }

}  // namespace racebeam
