// The next step of a session of the line protocol, for any transport. Sockets (connection.cpp), which wait in
// coroutines, and streams (streams.cpp), which block, share this loop.
#pragma once

#include <string_view>

#include "protocol/line_session.hpp"

namespace racebeam {

class SessionLoop {
 public:
  // What the transport does next. After each step except kDone, it calls work().
  enum class Next {
    kSend,   // sends output(), then asks sent() what is next
    kRead,   // waits for input
    kYield,  // lets other sessions work; this one has more to do
    kPause,  // waits for the recording, for about a millisecond
    kDone    // closes: no more output will follow
  };

  explicit SessionLoop(LineSession& session) : session_(session) {}

  // Carries out requests for a slice of time. `run` calls LineSession::run() and returns what it returned.
  template <typename Run>
  Next work(Run run) {
    more_ = run();
    return output().empty() ? next() : Next::kSend;
  }

  std::string_view output() const { return session_.output(); }

  // The transport calls this after it has sent all of output().
  Next sent() {
    session_.sent(output().size());
    return next();
  }

 private:
  Next next() const {
    if (session_.finished()) return Next::kDone;
    if (!more_) return Next::kRead;
    return session_.waits() ? Next::kPause : Next::kYield;
  }

  LineSession& session_;
  bool more_ = false;  // there is more to do without further input
};

}  // namespace racebeam
