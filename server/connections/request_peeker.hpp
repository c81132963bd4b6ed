// Finds requests that a client has sent ahead, while replies to earlier ones still wait to be sent. The
// requests are copied, but stay in the system's buffer until the replies are sent. Removing them earlier
// would wake the client for nothing, on a Unix socket, or send a separate acknowledgement, on TCP. With the
// replies, both happen anyway.
#pragma once

#include <cstddef>
#include <span>

#include "server/connections/client.hpp"

namespace racebeam {

class RequestPeeker {
 public:
  explicit RequestPeeker(Socket* socket);  // null: look() finds nothing

  // Copies bytes that have been received. The next reader sees them again until take(). Returns their number;
  // 0: none, or the end.
  std::size_t look(std::span<char> space);
  void take();  // removes what look() has found; before other reads

  // Flags for the next blocking read. If the client sleeps until its reply, they only copy its request, so
  // that it is not woken early. The caller must then tell how much was read.
  Socket::message_flags flags(bool client_sleeps) const;
  void was_read(Socket::message_flags flags, std::size_t count) { seen_ = flags != 0 ? count : 0; }

 private:
  Socket* socket_;
  bool wakes_ = false;  // the system wakes the client when its request is removed
  std::size_t seen_ = 0;
};

}  // namespace racebeam
