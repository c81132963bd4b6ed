// One session of the racebeam line protocol (protocol/PROTOCOL.md). It does not use files or sockets: bytes
// go in, and bytes come out. In between, run() works for a limited time, so that a thread can serve many
// sessions. No function throws or blocks.
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
  // The first two parameters must outlive the session. It counts into `meter`, if that is not null, on the
  // thread that calls run(). memory: its budget; null: the service's.
  explicit LineSession(const LineService& service, Meter* meter = nullptr,
                       const std::shared_ptr<MemoryBudget>& memory = nullptr);
  ~LineSession();
  LineSession(const LineSession&) = delete;
  LineSession& operator=(const LineSession&) = delete;

  // columns: the width of the user's terminal, for which replies of `help` have several lines. 0: a program
  // reads them.
  void set_columns(int columns);

  std::size_t longest_line() const;  // bytes that a request may have, now; without its end
  std::span<char> space();           // where input goes; do not read while it is empty
  void received(std::size_t count);  // this many bytes were added; 0: the client has closed its end

  // Executes requests, or a part of one, for about `slice`, or until there are enough replies to send.
  // Returns true if there is more to do: send the waiting output, and call it again.
  bool run(std::chrono::microseconds slice = kSlice);
  static constexpr std::chrono::microseconds kSlice{2000};  // how long other sessions may have to wait

  std::chrono::steady_clock::duration worked() const;  // duration of the last run()

  // A recording has no room for another frame: run() does nothing until it has. Other sessions have their
  // turn.
  bool waits() const;

  std::string_view output() const;  // to be sent; valid until run() or sent()
  void sent(std::size_t count);     // this many bytes of it were sent

  bool admitted() const;     // it has given its token, or does not need one
  int wrong_tokens() const;  // number of wrong tokens so far
  bool refused() const;      // ended by an error, with LineService::strict
  bool finished() const;     // there will be no more replies: send the output, then close
  void cancel();             // the client has disconnected: the request in progress is cancelled
  void release_caches();     // called when no request has come for a while

  std::string summary() const;  // for the log: what was played
 private:
  std::unique_ptr<Session> session_;
};

}  // namespace racebeam
