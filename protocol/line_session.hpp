// One session of the racebeam line protocol (protocol/PROTOCOL.md). It has never heard of files and sockets:
// bytes go in, bytes come out, and in between run() works for as long as it is told, so that a thread can
// serve many. Nothing here throws and nothing waits.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "protocol/line/line_service.hpp"
#include "protocol/line/meter.hpp"

namespace racebeam {

class Session;

class LineSession {
 public:
  // Both outlive the session. It counts into `meter`, if there is one, on the thread that calls run().
  explicit LineSession(const LineService& service, Meter* meter = nullptr);
  ~LineSession();
  LineSession(const LineSession&) = delete;
  LineSession& operator=(const LineSession&) = delete;

  // A person reads, on a terminal so wide: the replies of `help` have several lines. 0: a program does.
  void set_columns(int columns);

  std::span<char> space();           // where input goes; do not read while it is empty
  void received(std::size_t count);  // so much was put there; 0: the client has closed its end

  // Carries out requests, or a part of one, for about as long as `slice`, or until replies are worth sending.
  // Returns true when there is more to do: send the output that waits, and call it again.
  bool run(std::chrono::microseconds slice = kSlice);
  static constexpr std::chrono::microseconds kSlice{2000};  // what other sessions have to wait

  std::chrono::steady_clock::duration worked() const;  // how long the last run() took

  // Replies to requests that were sent ahead are there, and few such requests are left: if more have come by
  // now, hand them in and run() again; else send the output.
  bool wants_more() const;

  // What it records has no room for another frame: run() does nothing until it has. Others have their turn.
  bool waits() const;

  std::string_view output() const;  // to be sent; good until run() or sent()
  void sent(std::size_t count);     // so much of it is on its way

  bool admitted() const;     // it has given its token, or needs none
  int wrong_tokens() const;  // that it has given so far
  bool refused() const;      // ended by an error, as LineService::strict says
  bool finished() const;     // nothing will come any more: send the output, then close
  void cancel();             // the client has gone: what is under way is given up
  void rest();               // nothing has come for a while: memory is given back that only saves time

  std::string summary() const;  // for the log: what was played
 private:
  std::unique_ptr<Session> session_;
};

}  // namespace racebeam
