// Detects clients that disconnect during a long request.
#pragma once

#include "server/connections/client.hpp"

namespace racebeam {

class Departure {
 public:
  // Does not block, and sends nothing. A client that has only closed its sending end is still connected: it
  // may read the reply. On TCP, that looks like a client that has closed everything. The system knows the
  // difference if the client runs on this machine (system/program/sockets.hpp). The system of another machine
  // forgets a connection that its client has closed after a minute or so, and answers the next keep-alive
  // probe, which has no data, with a reset.
  bool has_gone(Socket& socket);

 private:
  bool half_closed_ = false;
  Clock::time_point looked_{};
};

}  // namespace racebeam
