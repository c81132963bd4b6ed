#pragma once

#include <charconv>
#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "racebeam/client/errors.hpp"

namespace racebeam::client::detail {

/// Where a server is.
struct Address {
  enum class Kind { kTcp, kTls, kUnix, kPipes, kStdio };
  Kind kind = Kind::kStdio;
  std::string place;       ///< host, path or prefix
  std::uint16_t port = 0;  ///< of kTcp and kTls
};

[[noreturn]] inline void refuse_address(std::string_view text) {
  throw std::invalid_argument(
      std::string("the address is '")
          .append(text)
          .append("'; it takes tcp://HOST:PORT, tls://HOST:PORT, unix:PATH, pipes:PREFIX, stdio or "
                  "file:PATH, also in RACEBEAM_ADDRESS"));
}

inline Address parse_address(std::string_view text);

/// The first address in a file that `racebeam serve --ready-file` wrote.
inline Address address_in_file(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw Lost(std::string("cannot read ").append(path));
  for (std::string line; std::getline(file, line);)
    for (const std::string_view usable : {"tcp:", "tls:", "unix:", "pipes:"})
      if (line.starts_with(usable)) return parse_address(line);
  throw std::invalid_argument(path + " names no address that this client can use");
}

/// Throws std::invalid_argument if the text is no address.
inline Address parse_address(std::string_view text) {
  if (text == "stdio") return {};
  const std::size_t colon = text.find(':');
  const std::string_view kind = text.substr(0, colon);
  std::string_view rest = colon == std::string_view::npos ? std::string_view{} : text.substr(colon + 1);
  if (rest.empty()) refuse_address(text);
  if (kind == "unix") return {Address::Kind::kUnix, std::string(rest)};
  if (kind == "pipes") return {Address::Kind::kPipes, std::string(rest)};
  if (kind == "file") return address_in_file(std::string(rest));
  const std::size_t end = rest.rfind(':');
  if ((kind != "tcp" && kind != "tls") || !rest.starts_with("//") || end == std::string_view::npos)
    refuse_address(text);
  Address address{kind == "tcp" ? Address::Kind::kTcp : Address::Kind::kTls,
                  std::string(rest.substr(2, end - 2))};
  const std::string_view port = rest.substr(end + 1);
  const auto [last, failure] = std::from_chars(port.data(), port.data() + port.size(), address.port);
  if (failure != std::errc{} || last != port.data() + port.size()) refuse_address(text);
  if (address.place.starts_with('[') && address.place.ends_with(']'))  // IPv6
    address.place = address.place.substr(1, address.place.size() - 2);
  if (address.place.empty()) refuse_address(text);
  return address;
}

}  // namespace racebeam::client::detail
