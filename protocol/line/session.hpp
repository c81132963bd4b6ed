// The inside of a LineSession: what the commands work on.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/line/line_reader.hpp"
#include "protocol/line/line_service.hpp"
#include "protocol/line/machines.hpp"
#include "protocol/line/meter.hpp"
#include "protocol/line/player.hpp"
#include "protocol/line/states.hpp"
#include "protocol/running/memory_budget.hpp"
#include "protocol/running/pacer.hpp"

namespace racebeam {

struct CommandTable;
class SessionRecording;

// What a machine may run beyond what was asked for: powering on and an ordinary reset take some 130 frames.
constexpr std::int64_t kFreeResetFrames = 1000;

// An image that a client has sent may be translated to so much code.
constexpr std::size_t kOwnImage = std::size_t{4} << 20;

struct Statistics {
  std::int64_t requests = 0, errors = 0, acts = 0, frames = 0, episodes = 0, bytes_in = 0, bytes_out = 0;
};

class Session {
 public:
  // All outlive the session. `counting` may be null.
  Session(const LineService& with, const CommandTable& table, Meter* counting);
  ~Session();

  const LineService& service;
  LineReader input;
  std::string out;
  bool quitting = false;
  bool admitted;         // true once a token was given, or where none is needed
  int wrong_tokens = 0;  // so far
  int columns = 0;       // of the terminal that a person reads; 0: a program does
  Statistics statistics;
  Pacer pacer;  // a request runs as its body

  // The game that was loaded; `player` is null without one.
  Cartridge cartridge;
  bool has_own_image = false;  // the client sent it; other sessions do not share it
  PlaySettings settings;
  std::vector<Field> fields;  // chosen by `observe`; stay when another game is loaded
  std::unique_ptr<Player> player;
  States states;
  std::unique_ptr<SessionRecording> recording;  // null: none was begun, or it was stopped

  MemoryShare memory;           // of the server's; what a request is going to take is checked before
  std::vector<Action> actions;  // of a request; kept for their memory
  std::vector<Act> step_acts;   // the same, of `step`
  Machines machines;

  // Throws Refusal when so many acts, and frames beside them, are more than a request may ask for.
  void check_frames(std::int64_t acts, std::int64_t frames = 0) const;
  void allow_resets(std::size_t machines);  // the request resets so many, for as long as its frames last
  void check_reply(std::size_t bytes, const std::string& about) const;  // throws Refusal when it is too long
  void admit();                                                         // a token was right
  void count(const Outcome& outcome);                                   // into the statistics
  void append_cut();               // to a reply, when the recording has ended too early
  void stop_recording_machines();  // those of `open` will go
  void run_parallel(std::size_t count, const std::function<void(std::size_t)>& task) const;

  std::span<char> space();
  bool run(std::chrono::microseconds slice);
  Pacer::Clock::duration worked() const { return worked_; }
  std::string_view whole_replies() const;  // not the one that is being worked on: it may yet be refused
  void sent(std::size_t count);            // of them
  bool wants_more() const;                 // see LineSession
  bool waits() const;                      // the same
  bool finished() const { return done_; }
  bool refused() const { return service.strict && statistics.errors > 0; }
  void cancel();
  void rest();

 private:
  using Clock = Pacer::Clock;

  bool has_enough() const;
  bool pauses() const;
  bool go_on(Clock::time_point end);
  bool ignores(const LineReader::Line& line);
  void begin_request();
  void take(const LineReader::Line& line);
  void execute(std::string_view line);
  void read_words(std::string_view line);
  void refuse(Code code, std::string_view sentence);
  void refuse_fault(const std::string& what);
  std::size_t footprint() const;
  void finish_reply();
  void measure();
  template <typename Step>
  void guarded(Step step);  // an exception becomes an error reply

  const CommandTable& table_;
  std::vector<std::string_view> words_;
  std::size_t reply_ = 0;         // where in `out` the current reply begins
  int unsent_ = 0;                // whole replies in `out`
  std::int64_t sent_frames_ = 0;  // of the pacer's, those before the replies in `out`
  bool done_ = false;
  Clock::time_point began_;   // the current request
  Clock::time_point looked_;  // at the clock, the last time
  Clock::duration worked_{};  // in the last run()

  // The server's metrics of this session; null: none.
  Meter* meter_;
  std::size_t command_ = 0;  // of the request: its row in the table
  bool refused_ = false;
  std::int64_t metered_frames_ = 0;
};

}  // namespace racebeam
