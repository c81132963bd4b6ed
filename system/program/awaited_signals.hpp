// Signals that a process with one thread waits for, instead of handling them. Windows lacks them.
#pragma once

#include <memory>
#include <span>

namespace racebeam {

class AwaitedSignals {
 public:
  struct Signal {
    int number = 0;              // 0: no signal came in time
    bool from_terminal = false;  // the terminal has sent it, also to the other processes in its foreground
  };

  explicit AwaitedSignals(std::span<const int> numbers);  // blocks these signals from now on
  ~AwaitedSignals();
  AwaitedSignals(const AwaitedSignals&) = delete;
  AwaitedSignals& operator=(const AwaitedSignals&) = delete;

  Signal next(int milliseconds = -1) const;  // waits at most this long; -1: until a signal comes

  void handle_as_before() const;  // in a child: handles the signals as before

 private:
  struct Sets;
  std::unique_ptr<Sets> sets_;
};

}  // namespace racebeam
