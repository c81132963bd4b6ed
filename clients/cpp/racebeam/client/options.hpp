/// @file
/// Options of a connection to a server. Each session copies the options that it is given.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>

#include "racebeam/client/config.hpp"

namespace RACEBEAM_CLIENT_NAMESPACE {

/// How to connect to a server.
struct Options {
  std::string token;  ///< sent with `hello`, if not empty
  std::optional<std::chrono::milliseconds>
      timeout;              ///< the longest wait for a connection or a reply; else no limit
  std::string authorities;  ///< a PEM file of certificates to trust, for tls://; else the system's
  std::size_t longest_reply = std::size_t{1} << 28U;  ///< bytes; a longer reply ends the session

  /// No token, no time limit, the system's certificates.
  static const Options& usual() {
    static const Options options;
    return options;
  }
};

}  // namespace RACEBEAM_CLIENT_NAMESPACE
