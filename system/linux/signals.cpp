#include "system/program/signals.hpp"

#include <signal.h>

#include <array>
#include <cstddef>

namespace racebeam {
namespace {

constexpr std::array kEnding = {SIGTERM, SIGINT};
constexpr std::array kInterrupting = {SIGHUP, SIGINT, SIGTERM};

// These are global because a signal handler cannot get an argument from the program.
volatile sig_atomic_t came = 0;  // the number of the signal
std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free);

void remember(int number) {
  came = number;
  interrupted = true;
}

}  // namespace

std::span<const int> ending_signals() { return kEnding; }
int reading_signal() { return SIGHUP; }
void ignore_reading_signal() { ::signal(SIGHUP, SIG_IGN); }
void ignore_left_readers() { ::signal(SIGPIPE, SIG_IGN); }
void ignore_full_files() { ::signal(SIGXFSZ, SIG_IGN); }

struct Interruption::Before {
  std::array<struct sigaction, kInterrupting.size()> actions{};
};

Interruption::Interruption() : before_(std::make_unique<Before>()) {
  came = 0;
  interrupted = false;
  struct sigaction action {};
  action.sa_handler = remember;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  for (std::size_t i = 0; i < kInterrupting.size(); ++i) {
    ::sigaction(kInterrupting[i], nullptr, &before_->actions[i]);
    if (before_->actions[i].sa_handler != SIG_IGN) ::sigaction(kInterrupting[i], &action, nullptr);
  }
}

Interruption::~Interruption() {
  for (std::size_t i = 0; i < kInterrupting.size(); ++i)
    ::sigaction(kInterrupting[i], &before_->actions[i], nullptr);
  if (came != 0) ::raise(came);
}

void Interruption::check() const {
  if (interrupted) throw Interrupted();
}

std::shared_ptr<const std::atomic<bool>> Interruption::flag() {
  return {std::shared_ptr<void>(), &interrupted};
}

}  // namespace racebeam
