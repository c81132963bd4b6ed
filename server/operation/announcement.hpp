// The texts of the files that announce a server to clients.
#pragma once

#include <string>
#include <vector>

namespace racebeam {

struct Announcement {
  std::vector<std::string> addresses;  // of endpoints with the line protocol, in the order of --listen
  std::string host, version, token;
  int process = 0;
  std::vector<std::string> games;  // the games that clients may load
};

std::string host_name();  // of this machine

// The text of a ready file: the addresses, one a line.
std::string ready_text(const std::vector<std::string>& addresses);

// The text of an announce file: one JSON object. Each member begins a line, and each address has its own
// line, so that programs without a JSON parser can read it.
std::string announce_text(const Announcement& announcement);

}  // namespace racebeam
