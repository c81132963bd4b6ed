// Signals that end a command which has something to remove first.
#pragma once

#include <signal.h>

#include <array>
#include <atomic>
#include <memory>
#include <stdexcept>

namespace racebeam {

struct Interrupted : std::runtime_error {
  Interrupted() : std::runtime_error("interrupted by a signal") {}
};

// While it lives, the first SIGHUP, SIGINT or SIGTERM sets a flag; the second ends the process at once.
// Signals that the process ignores stay ignored. One object at a time.
class Interruption {
 public:
  Interruption();
  ~Interruption();  // handles signals as before, so that the process ends by the one that has come
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  void check() const;  // throws Interrupted
  static std::shared_ptr<const std::atomic<bool>> flag();

 private:
  static constexpr std::array kSignals = {SIGHUP, SIGINT, SIGTERM};

  std::array<struct sigaction, kSignals.size()> before_{};
};

}  // namespace racebeam
