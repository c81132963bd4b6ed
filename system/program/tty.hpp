// The controlling terminal, from which keys are read at once, and not shown. Not available on Windows.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>

namespace racebeam {

// In cells, and the pixels of a cell. These are the usual values.
struct TerminalSize {
  std::size_t columns = 80, rows = 24;
  std::size_t cell_width = 8, cell_height = 16;
};

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

  TerminalSize size() const;  // what the terminal does not say has its usual value

 private:
  void flush();
  static std::string read();  // what has come

  std::string waiting_;  // to be written
};

}  // namespace racebeam
