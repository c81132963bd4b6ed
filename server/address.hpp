// Where to listen, as the command line has it: tcp://HOST:PORT or unix:PATH.
#pragma once

#include <cstdint>
#include <string>
#include <variant>

namespace racebeam {

struct TcpAddress {
  std::string host;  // an IP address
  std::uint16_t port = 0;
};

struct UnixAddress {
  std::string path;
};

using Address = std::variant<TcpAddress, UnixAddress>;

Address parse_address(const std::string& text);  // throws std::invalid_argument with a sentence

std::string to_string(const TcpAddress& address);

}  // namespace racebeam
