// One session of the racebeam line protocol (PROTOCOL.md). It has never heard of files and sockets: bytes go
// in, bytes come out, and in between run() works for as long as it is told, so that a thread can serve many.
// Nothing here throws and nothing waits.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "emulator/translator/translator.hpp"
#include "protocol/line/images.hpp"
#include "protocol/line/meter.hpp"
#include "protocol/running/memory_budget.hpp"

namespace racebeam {

class Recorder;

// What one client may use. `hello` tells.
struct LineLimits {
  std::size_t line = 1 << 20;               // bytes of a request; an image of the largest size fits as base64
  std::size_t output = 1 << 18;             // bytes that wait for the reader; above, no request is begun
  std::size_t reply = 1 << 26;              // bytes of a reply that one may ask for, as PROTOCOL.md counts
  int machines = 256;                       // of `open`
  int states = 256;                         // saved at a time
  std::int64_t request_frames = 2'000'000;  // that one request may ask for
  std::size_t recording = 1 << 30;          // bytes of one recording
  std::int64_t idle_seconds = 0;            // without a word, after which the server ends it; 0: never
};

// Runs task(0) ... task(count - 1), on several threads if it likes, and returns when all are done. A task
// does not throw.
using Parallel = std::function<void(std::size_t count, const std::function<void(std::size_t)>& task)>;

// Whether a token is one of those that the server knows. From any thread.
using Admission = std::function<bool(std::string_view token)>;

// What all sessions of a server share, all of it const, or made for many threads.
struct LineService {
  std::string version = "0";
  std::shared_ptr<const Images> images;
  LineLimits limits;
  std::shared_ptr<Recorder> recorder;  // null: nothing is recorded
  Parallel parallel;                   // empty: one after the other
  std::size_t threads = 1;             // that `parallel` has
  Admission admission;                 // empty: everyone may play; else whose `hello` gives a token
  CpuKind cpu = CpuKind::kAuto;        // of all machines
  std::shared_ptr<MemoryBudget> memory;  // of all sessions; null: there is no limit
  bool strict = false;           // the first error ends a session; for scripts
  std::function<void(const std::string& sentence)> report_fault;  // an `internal` error; from any thread; may be empty
};

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
