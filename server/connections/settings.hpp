// How a server is set up; the protocols' own limits are in their services.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "server/access/address.hpp"

namespace racebeam {

struct ServerSettings {
  std::vector<Endpoint> endpoints;
  std::string ready_file;  // gets the addresses once all are served; empty: none
  std::string token_file;  // clients over TCP have to give one of its tokens; empty: no tokens
  std::string tls_certificate, tls_key;
  std::string http;                          // HOST:PORT for health and metrics; empty: none
  int threads = 1;                           // that serve sockets
  std::string threads_limited_by;            // why there are no more, for the log
  std::chrono::microseconds busy_poll{100};  // that a thread waits awake for a quick client; 0: never
  std::uint64_t max_memory = 0;  // bytes that the server may hold; 0: no limit
  int max_sessions = 4096;                   // at a time
  int idle_seconds = 86400;    // without a byte to or from a client, after which it is closed; 0: never
  int handshake_seconds = 10;  // that a client has to finish TLS and to give its token
  int grace_seconds = 5;       // that sessions have once the server is told to stop
};

}  // namespace racebeam
