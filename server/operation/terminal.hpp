// Whether a descriptor is a terminal.
#pragma once

#include <sys/ioctl.h>
#include <unistd.h>

namespace racebeam {

// The width of the terminal `file` in columns; 0 if it is not a terminal.
inline int terminal_columns(int file) {
  constexpr int kUsual = 80;  // if the terminal does not tell
  if (::isatty(file) == 0) return 0;
  winsize size{};
  return ::ioctl(file, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kUsual;
}

}  // namespace racebeam
