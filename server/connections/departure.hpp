// Detects clients that disconnect during a long request.
#pragma once

#include "server/connections/client.hpp"

namespace racebeam {

class Departure {
 public:
  // Does not block. A client that has only closed its sending end has not gone: it may read the reply. On
  // TCP, that looks like a client that has closed everything, until the server sends something. The server
  // therefore sends a byte of urgent data now and then. Receivers leave it out of the stream, unless they
  // request it (SO_OOBINLINE). The system of a client that has gone answers with a reset, which the next call
  // detects.
  bool has_gone(Socket& socket);

 private:
  Clock::time_point probed_{};
};

}  // namespace racebeam
