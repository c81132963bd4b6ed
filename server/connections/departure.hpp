// Finds out whether a client is still there while a long request is under way.
#pragma once

#include "server/connections/client.hpp"

namespace racebeam {

class Departure {
 public:
  // Without waiting. A client that has only closed its sending end is still there: it may read the reply. On
  // TCP that looks like a client that has closed all, until the server sends something. So the server then
  // sends a byte of urgent data now and then: receivers leave it out of the stream, unless they ask for it
  // (SO_OOBINLINE), and the system of a client that has gone answers with a reset, which the next call sees.
  bool has_gone(Socket& socket);

 private:
  Clock::time_point probed_{};
};

}  // namespace racebeam
