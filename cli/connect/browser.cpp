#include "cli/connect/browser.hpp"

#include <cstdlib>

namespace racebeam {

std::optional<std::vector<std::string>> browser_command(const std::string& address) {
#if defined(__APPLE__)
  return std::vector<std::string>{"open", address};
#else
  for (const char* const name : {"DISPLAY", "WAYLAND_DISPLAY"}) {
    const char* const display = std::getenv(name);
    if (display != nullptr && *display != '\0') return std::vector<std::string>{"xdg-open", address};
  }
  return std::nullopt;
#endif
}

}  // namespace racebeam
