// The settings of a server. The limits of the protocols are in their services.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "server/access/address.hpp"

namespace racebeam {

struct ServerSettings {
  std::vector<Endpoint> endpoints;
  std::string ready_file;  // file for the addresses, written when all are served; empty: none
  std::string announce;    // file of JSON that tells clients of the server; empty: none
  std::string token_file;  // tokens, one of which clients over TCP must give; empty: no tokens
  std::string tls_certificate, tls_key;
  std::string http;                          // HOST:PORT for the page, health and metrics; empty: none
  std::vector<std::string> allowed_origins;  // origins of other pages that may open sessions
  int threads = 1;                           // of event loops
  std::string threads_limited_by;            // what limits their number, for the log
  std::chrono::microseconds busy_poll{100};  // how long a thread polls for a quick client; 0: never
  std::uint64_t max_memory = 0;              // bytes for all sessions; 0: no limit
  std::string memory_limited_by;             // what limits them, for the log
  std::string caches;                        // the sizes of what sessions share, for the log
  int max_sessions = 4096;                   // sessions at the same time
  std::string sessions_limited_by;           // what limits them, for the log; empty: only their option
  int max_connections = 1 << 20;             // on sockets, including those that are being closed
  int idle_seconds = 86400;                  // timeout without a byte to or from a client; 0: never
  int handshake_seconds = 10;                // timeout for TLS and the token
  int grace_seconds = 5;                     // until sessions end after the server is asked to stop
  int until_idle_seconds = 0;  // the server stops after this time without an admitted session; 0: never
};

}  // namespace racebeam
