// The address of a server's page.
#pragma once

#include <string>

namespace racebeam {

// The address for a browser, without a path: http://HOST:PORT or https://HOST:PORT. Empty if `address` is not
// that of a WebSocket or a page.
std::string page_address(const std::string& address);

// The page of the first WebSocket in an announce file; empty if the file names no WebSocket. `token` gets the
// file's token. Throws std::exception if the file cannot be read.
std::string announced_page(const std::string& path, std::string& token);

}  // namespace racebeam
