// Requests that a client has sent ahead, found while replies to those before them still wait to be sent. They
// are read, but left with the system until the replies are on their way: taking them out makes it wake the
// client up for nothing, on a Unix socket, and send an acknowledgement of its own, on TCP. With the replies,
// the client is woken up and the acknowledgement goes along.
#pragma once

#include <cstddef>
#include <span>

#include "server/client.hpp"

namespace racebeam {

class LookAhead {
 public:
  explicit LookAhead(Socket* socket)
      : socket_(socket) {}  // null: there is none to look into, nothing is found

  // Bytes that have come by now, also seen by the next reader until take(); 0: none, or nothing will come.
  std::size_t look(std::span<char> space);
  void take();  // what look() has found; before anybody else reads

 private:
  Socket* socket_;
  std::size_t seen_ = 0;
};

}  // namespace racebeam
