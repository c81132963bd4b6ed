// The file that tells clients of a server, as the C++ client reads it. After an even first byte the input is
// the file. Otherwise it is what a server announces, a line each: its token, and addresses.
#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <string>

#include "fuzz/support/memory_file.hpp"
#include "fuzz/support/target.hpp"
#include "racebeam/client/address.hpp"
#include "server/operation/announcement.hpp"

namespace racebeam::fuzz {
namespace {

namespace client = racebeam::client;

void read(std::string_view text) {
  const MemoryFile file(text);
  try {
    const client::detail::Address address = client::detail::address_in_file(file.path());
    require(address.kind != client::detail::Address::Kind::kStdio, "a file names no standard streams");
  } catch (const std::invalid_argument& refusal) {
    require(*refusal.what() != '\0', "a refused file gives a sentence");
  }
}

// The server accepts only such tokens and addresses.
bool is_word(std::string_view text) { return is_printable(text) && text.find(' ') == std::string_view::npos; }

void announce(std::string_view text) {
  Announcement announcement;
  announcement.host = "host";
  announcement.version = "0.1.0";
  announcement.games = {"beamfall"};
  std::istringstream lines{std::string(text)};
  std::getline(lines, announcement.token);
  for (std::string line; std::getline(lines, line);) announcement.addresses.push_back(line);
  if (!is_word(announcement.token) || !std::ranges::all_of(announcement.addresses, is_word)) return;
  const MemoryFile file(announce_text(announcement));
  const client::detail::ServerFile found(file.path());
  require(found.addresses == announcement.addresses, "a client reads the addresses that a server announces",
          text);
  require(found.token == announcement.token, "a client reads the token that a server announces", text);
}

}  // namespace

void run(Bytes input) {
  Reader reader(input);
  const bool is_announced = (reader.byte() & 1) != 0;
  is_announced ? announce(text_of(reader.rest())) : read(text_of(reader.rest()));
}

}  // namespace racebeam::fuzz
