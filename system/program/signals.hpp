// Signals that tell a process what to do.
#pragma once

#include <atomic>
#include <memory>
#include <span>
#include <stdexcept>

namespace racebeam {

// Those that end a process in an orderly way: SIGTERM and SIGINT. On Windows, these are Ctrl-C, Ctrl-Break,
// and the end of the console, the session or the system, which waits for the process some seconds.
std::span<const int> ending_signals();

// SIGHUP, which tells a server to read its files again; 0: the system lacks it.
int reading_signal();
void ignore_reading_signal();

// A reader that has left, and a file that may not grow, are errors of those who write.
void ignore_left_readers();
void ignore_full_files();

struct Interrupted : std::runtime_error {
  Interrupted() : std::runtime_error("interrupted by a signal") {}
};

// While it lives, the first signal that would end the process sets a flag; the second ends the process at
// once. Signals that the process ignores stay ignored. One object at a time.
class Interruption {
 public:
  Interruption();
  ~Interruption();  // handles signals as before, so that the process ends by the one that has come
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  void check() const;  // throws Interrupted
  static std::shared_ptr<const std::atomic<bool>> flag();

 private:
  struct Before;
  std::unique_ptr<Before> before_;
};

}  // namespace racebeam
