// Whether a person sits in front.
#pragma once

#include <sys/ioctl.h>
#include <unistd.h>

namespace racebeam {

// How wide the terminal behind `file` is; 0 if it is none.
inline int terminal_columns(int file) {
  constexpr int kUsual = 80;  // where it does not say
  if (::isatty(file) == 0) return 0;
  winsize size{};
  return ::ioctl(file, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kUsual;
}

}  // namespace racebeam
