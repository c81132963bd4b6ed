// Addresses as people type them.
#pragma once

#include <string>

namespace racebeam {

// HOST:PORT, or [IPv6]:PORT, as tcp://HOST:PORT. Any other text as it is.
std::string server_address(const std::string& text);

}  // namespace racebeam
