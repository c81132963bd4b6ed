/// @file
/// The addresses of servers, and the files that name them. Any thread may call these functions.
#pragma once

#include <charconv>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "racebeam/client/config.hpp"
#include "racebeam/client/errors.hpp"

namespace RACEBEAM_CLIENT_NAMESPACE::detail {

/// Where a server is.
struct Address {
  enum class Kind { kTcp, kTls, kUnix, kPipes, kStdio };
  Kind kind = Kind::kStdio;
  std::string place;        ///< host, path or prefix
  std::uint16_t port = 0;   ///< port of kTcp and kTls
  std::string token = {};   ///< token of an announce file
  std::string source = {};  ///< for error messages: the address that a file names, and the file
};

[[noreturn]] inline void refuse_address(std::string_view text) {
  const std::string problem = text.empty()
                                  ? "no address was given, and the variable RACEBEAM_ADDRESS is not set"
                                  : std::string("the address is '").append(text).append("'");
  throw std::invalid_argument(
      problem +
      "; it takes tcp://HOST:PORT, tls://HOST:PORT, unix:PATH, pipes:PREFIX, stdio or "
      "file:PATH, also in RACEBEAM_ADDRESS");
}

inline Address parse_address(std::string_view text);

/// The texts in quotes of a line of JSON, without their escapes: of an address, or of a key and its value.
inline std::vector<std::string> quoted_texts(std::string_view line) {
  std::vector<std::string> texts;
  bool inside = false;
  for (std::size_t at = 0; at < line.size(); ++at) {
    if (line[at] == '"') {
      inside = !inside;
      if (inside) texts.emplace_back();
    } else if (inside) {
      if (line[at] == '\\' && at + 1 < line.size()) ++at;
      texts.back() += line[at];
    }
  }
  return texts;
}

/// The addresses of a ready file, or those of an announce file and its token (server/README.md, "The announce
/// file").
class ServerFile {
 public:
  explicit ServerFile(const std::string& path) {
    const auto kind = std::filesystem::status(path).type();
    if (kind != std::filesystem::file_type::regular && kind != std::filesystem::file_type::not_found)
      refuse(path, "is not a regular file");  // a pipe might block
    std::ifstream file(path);
    if (!file) throw Lost(std::string("cannot read ").append(path));
    for (std::string line; std::getline(file, line);) addresses.push_back(line);
    if (addresses.empty()) refuse(path, "is empty");
    is_known = addresses[0].starts_with('{') || addresses[0].starts_with('#');
    if (addresses[0].starts_with('{')) read_announcement(path);
  }

  [[noreturn]] static void refuse(const std::string& path, std::string_view why) {
    throw std::invalid_argument(std::string(path).append(" ").append(why).append(
        "; file:PATH takes the --ready-file or --announce file of a server"));
  }

  std::vector<std::string> addresses;
  std::string token;
  bool is_known = false;  ///< an announce file, or a ready file by its first line

 private:
  void read_announcement(const std::string& path) {
    constexpr std::string_view kVersion = "{\"racebeam_announce\": ", kAddress = "  \"",
                               kToken = " \"token\": \"";
    const std::vector<std::string> lines = std::move(addresses);
    addresses.clear();
    if (!lines[0].starts_with(kVersion) || !lines.back().starts_with(kToken) ||
        !lines.back().ends_with("\"}"))
      throw std::invalid_argument(path + " is not a whole announce file");
    if (lines[0].substr(kVersion.size()) != "1,")
      throw std::invalid_argument(path +
                                  " is an announce file of another version than 1, which this client reads");
    for (const std::string& line : lines)
      if (line.starts_with(kAddress)) addresses.push_back(quoted_texts(line).at(0));
    token = quoted_texts(lines.back()).at(1);
  }
};

/// The first address in a file that `racebeam serve --ready-file` or `--announce` wrote.
inline Address address_in_file(const std::string& path) {
  const ServerFile file(path);
  for (const std::string& text : file.addresses) {
    for (const std::string_view usable : {"tcp:", "tls:", "unix:", "pipes:"}) {
      if (!text.starts_with(usable)) continue;
      Address address = parse_address(text);
      address.token = file.token;
      address.source = text + ", which " + path + " names";
      return address;
    }
  }
  if (!file.is_known) ServerFile::refuse(path, "has other contents");
  throw std::invalid_argument(path + " names no address that this client can use");
}

/// `file:PATH?wait=SECONDS` without what begins at the question mark, and the seconds; else the text, and 0.
/// Throws std::invalid_argument if what follows is not a time.
inline std::pair<std::string_view, double> without_wait(std::string_view text) {
  constexpr std::string_view kWait = "?wait=";
  const std::size_t at = text.rfind(kWait);
  if (!text.starts_with("file:") || at == std::string_view::npos) return {text, 0};
  double seconds = 0;
  const std::string_view number = text.substr(at + kWait.size());
  const auto [end, failure] =
      std::from_chars(number.data(), number.data() + number.size(), seconds, std::chars_format::fixed);
  if (failure != std::errc{} || end != number.data() + number.size() || !(seconds >= 0 && seconds < 1e9))
    throw std::invalid_argument(
        std::string("the address is '").append(text).append("'; ?wait= takes seconds, from 0 to 999999999"));
  return {text.substr(0, at), seconds};
}

/// Throws std::invalid_argument if the text is not an address.
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

}  // namespace RACEBEAM_CLIENT_NAMESPACE::detail
