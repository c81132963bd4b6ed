#include "system/program/signals.hpp"

#include <windows.h>

#include <array>
#include <csignal>
#include <cstddef>

namespace racebeam {
namespace {

constexpr std::array kEnding = {SIGTERM, SIGINT, SIGBREAK};

std::atomic<int> came = 0;  // the number of the signal
std::atomic<bool> interrupted = false;

// The C library has reset the handler when it calls this.
void remember(int number) {
  came = number;
  interrupted = true;
}

// Handles the end of the console, the session or the system. The process ends when this returns, or when the
// system has waited long enough, so it does not return.
BOOL WINAPI end_in_order(DWORD event) {
  if (event == CTRL_C_EVENT || event == CTRL_BREAK_EVENT) return FALSE;  // the C library raises a signal
  std::raise(SIGBREAK);
  Sleep(INFINITE);
  return TRUE;
}

}  // namespace

std::span<const int> ending_signals() {
  static const BOOL prepared = SetConsoleCtrlHandler(end_in_order, TRUE);
  static_cast<void>(prepared);
  return kEnding;
}

int reading_signal() { return 0; }
void ignore_reading_signal() {}
void ignore_left_readers() {}
void ignore_full_files() {}

struct Interruption::Before {
  std::array<void (*)(int), kEnding.size()> handlers{};
};

Interruption::Interruption() : before_(std::make_unique<Before>()) {
  came = 0;
  interrupted = false;
  for (std::size_t i = 0; i < kEnding.size(); ++i) {
    before_->handlers[i] = std::signal(kEnding[i], remember);
    if (before_->handlers[i] == SIG_IGN) std::signal(kEnding[i], SIG_IGN);
  }
}

Interruption::~Interruption() {
  for (std::size_t i = 0; i < kEnding.size(); ++i) std::signal(kEnding[i], before_->handlers[i]);
  if (came != 0) std::raise(came);
}

void Interruption::check() const {
  if (interrupted) throw Interrupted();
}

std::shared_ptr<const std::atomic<bool>> Interruption::flag() {
  return {std::shared_ptr<void>(), &interrupted};
}

}  // namespace racebeam
