// Who may come in: an address to listen on, the origin and the host of a browser's request, a token, and the
// file of tokens. The input has the first four as lines; the file is the rest.
#include <arpa/inet.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <sstream>
#include <stdexcept>

#include "fuzz/support/memory_file.hpp"
#include "fuzz/support/target.hpp"
#include "server/access/address.hpp"
#include "server/access/tokens.hpp"
#include "server/web/origin.hpp"
#include "system/printable.hpp"

namespace racebeam::fuzz {
namespace {

// Takes the first line from the text, without its end.
std::string line_of(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string line(text.substr(0, end));
  text.remove_prefix(std::min(end + 1, text.size()));
  return line;
}

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

void try_address(const std::string& text) {
  std::string written;
  try {
    written = to_string(parse_endpoint(text));
  } catch (const std::invalid_argument& refusal) {
    require(printable(refusal.what()) == refusal.what(), "a refused address gives a printable sentence",
            refusal.what());
    return;
  }
  require(to_string(parse_endpoint(written)) == written, "an address is written as it was read", written);
}

bool is_this_machine_or_number(std::string host) {
  std::array<unsigned char, 16> bytes{};
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  return lower(host) == "localhost" || ::inet_pton(AF_INET, host.c_str(), bytes.data()) == 1 ||
         ::inet_pton(AF_INET6, host.substr(0, host.find('%')).c_str(), bytes.data()) == 1;
}

void try_origin(const std::string& origin, const std::string& host) {
  require(admits({.allowed = {origin}}, origin, host), "an origin that is allowed is admitted", origin);
  if (!admits({}, origin, host)) return;
  const std::size_t scheme = origin.find("://");
  require(scheme != std::string::npos && is_origin(origin), "only an origin is admitted", origin);
  const std::string place = origin.substr(scheme + 3);
  require(lower(place) == lower(host), "the origin is that of the host", origin + " " + host);
  const std::size_t port = place.ends_with(']') ? std::string::npos : place.rfind(':');
  require(is_this_machine_or_number(place.substr(0, port)), "its host has no name of elsewhere", origin);
}

// Whether the file lists the token, which has no end of line.
bool lists(std::string_view file, std::string_view token) {
  std::istringstream lines{std::string(file)};
  for (std::string line; std::getline(lines, line);) {
    line.resize(line.find_last_not_of("\r ") + 1);
    if (line == token) return true;
  }
  return false;
}

void try_tokens(const std::string& token, std::string_view text) {
  const MemoryFile file(text);
  try {
    const Tokens tokens(file.path());
    const bool listed = !token.empty() && !token.starts_with('#') && lists(text, token);
    require(tokens.admits(token) == listed, "a token is admitted if the file lists it", token);
  } catch (const std::runtime_error& refusal) {
    require(printable(refusal.what()) == refusal.what(), "a refused file gives a printable sentence",
            refusal.what());
  }
}

}  // namespace

void run(Bytes input) {
  std::string_view rest = text_of(input);
  const std::string address = line_of(rest), origin = line_of(rest), host = line_of(rest);
  const std::string token = line_of(rest);
  try_address(address);
  try_origin(origin, host);
  try_tokens(token, rest);
}

}  // namespace racebeam::fuzz
