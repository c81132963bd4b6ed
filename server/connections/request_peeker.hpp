// Requests that a client has sent ahead, found while replies to those before them still wait to be sent. They
// are read, but left with the system until the replies are on their way: taking them out makes it wake the
// client up for nothing, on a Unix socket, and send an acknowledgement of its own, on TCP. With the replies,
// the client is woken up and the acknowledgement goes along.
#pragma once

#include <cstddef>
#include <span>

#include "server/connections/client.hpp"

namespace racebeam {

class RequestPeeker {
 public:
  explicit RequestPeeker(Socket* socket);  // null: there is none to look into, nothing is found

  // Bytes that have come by now, also seen by the next reader until take(); 0: none, or nothing will come.
  std::size_t look(std::span<char> space);
  void take();  // what look() has found; before anybody else reads

  // For who reads next, and waits for it. A client that sleeps until its reply is there is not woken up
  // before, either, if its request is looked at only: the flag says so, and what was read is to be told.
  Socket::message_flags flags(bool client_sleeps) const;
  void was_read(Socket::message_flags flags, std::size_t count) { seen_ = flags != 0 ? count : 0; }

 private:
  Socket* socket_;
  bool wakes_ = false;  // the system wakes the client up when its request is taken
  std::size_t seen_ = 0;
};

}  // namespace racebeam
