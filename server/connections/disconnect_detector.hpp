// Detects clients that disconnect during a long request.
#pragma once

#include "server/connections/client.hpp"

namespace racebeam {

class DisconnectDetector {
 public:
  // Does not block, and sends nothing. A client that has only closed its sending end is still connected: it
  // may read the reply. On TCP, that looks like a client that has closed everything. If the client runs on
  // this machine, the system knows the difference (system/program/sockets.hpp). If it runs on another
  // machine, that system forgets a closed connection after a minute or so. It then answers the next
  // keep-alive probe, which does not carry data, with a reset.
  bool has_gone(Socket& socket);

 private:
  bool half_closed_ = false;
  Clock::time_point looked_{};
};

}  // namespace racebeam
