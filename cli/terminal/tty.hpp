// The controlling terminal, from which keys are read at once, and not shown.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

#include "cli/terminal/picture.hpp"

namespace racebeam {

// At most one at a time. However the process ends, except by SIGKILL, the terminal is as before: the signals
// that end a process restore it first. Ctrl-Z does nothing.
class Tty {
 public:
  using Time = std::chrono::steady_clock::time_point;

  Tty();   // throws std::runtime_error without a terminal
  ~Tty();  // what was not written yet is left out
  Tty(const Tty&) = delete;
  Tty& operator=(const Tty&) = delete;

  // Writes `text` that changes how the terminal works. `undo` is written at the end, in the opposite order.
  void change(std::string_view text, std::string_view undo);

  void write(std::string_view text);  // never blocks; wait() writes what the terminal does not take yet
  bool is_idle() const { return waiting_.empty(); }  // all was written

  // Waits until bytes come, and returns them; none if it is `until`, or if `writes_too` and all was written.
  // Throws std::runtime_error if the terminal is gone.
  std::string wait(Time until, bool writes_too = false);

  Room room() const;  // the whole terminal

 private:
  void flush();
  static std::string read();  // what has come

  std::string waiting_;  // to be written
};

}  // namespace racebeam
