#include "cli/commands/interruption.hpp"

#include <cstddef>

namespace racebeam {
namespace {

// What a signal handler needs. A handler has no argument of ours.
volatile sig_atomic_t came = 0;  // the number of the signal
std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free);

void remember(int number) {
  came = number;
  interrupted = true;
}

}  // namespace

Interruption::Interruption() {
  came = 0;
  interrupted = false;
  struct sigaction action {};
  action.sa_handler = remember;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    ::sigaction(kSignals[i], nullptr, &before_[i]);
    if (before_[i].sa_handler != SIG_IGN) ::sigaction(kSignals[i], &action, nullptr);
  }
}

Interruption::~Interruption() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) ::sigaction(kSignals[i], &before_[i], nullptr);
  if (came != 0) ::raise(came);
}

void Interruption::check() const {
  if (interrupted) throw Interrupted();
}

std::shared_ptr<const std::atomic<bool>> Interruption::flag() {
  return {std::shared_ptr<void>(), &interrupted};
}

}  // namespace racebeam
