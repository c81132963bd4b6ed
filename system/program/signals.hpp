// Signals that control a process.
#pragma once

#include <atomic>
#include <memory>
#include <span>
#include <stdexcept>

namespace racebeam {

// The signals that end a process in an orderly way: SIGTERM and SIGINT. On Windows, they stand for Ctrl-C,
// Ctrl-Break, and the end of the console, the session or the system, which gives the process some seconds.
std::span<const int> ending_signals();

// SIGHUP, at which a server reads its files again; 0 if the system does not have it.
int reading_signal();
void ignore_reading_signal();

// After these calls, a write to a reader that has left, or to a file that may not grow, fails with an error
// instead of a signal.
void ignore_left_readers();
void ignore_full_files();

struct Interrupted : std::runtime_error {
  Interrupted() : std::runtime_error("interrupted by a signal") {}
};

// During its lifetime, the first signal that would end the process sets a flag; the second ends the process
// at once. Signals that the process ignores stay ignored. Only one such object may exist at a time.
class Interruption {
 public:
  Interruption();
  ~Interruption();  // handles signals as before, so that a signal that has come ends the process
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  void check() const;  // throws Interrupted
  static std::shared_ptr<const std::atomic<bool>> flag();

 private:
  struct Before;
  std::unique_ptr<Before> before_;
};

}  // namespace racebeam
