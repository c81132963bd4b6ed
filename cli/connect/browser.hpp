// The program of the desktop that opens a page.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace racebeam {

// The command that opens the address in a browser; nothing without a desktop.
std::optional<std::vector<std::string>> browser_command(const std::string& address);

}  // namespace racebeam
