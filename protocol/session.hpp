// The inside of a LineSession: what the commands work on.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/branch.hpp"
#include "protocol/line_reader.hpp"
#include "protocol/line_session.hpp"
#include "protocol/machines.hpp"
#include "protocol/player.hpp"
#include "protocol/work.hpp"

namespace racebeam {

struct Command;
class Recording;

struct Statistics {
  std::int64_t requests = 0, errors = 0, acts = 0, frames = 0, episodes = 0, bytes_in = 0, bytes_out = 0;
};

class Session {
 public:
  Session(const LineService& with, Meter* counting);
  ~Session();

  const LineService& service;
  LineReader input;
  std::string out;
  bool quitting = false;
  bool admitted;         // true once a token was given, or where none is needed
  int wrong_tokens = 0;  // so far
  Statistics statistics;

  // The game that was loaded; `player` is null without one.
  Cartridge cartridge;
  PlaySettings settings;
  std::vector<Field> fields;  // chosen by `observe`; stay when another game is loaded
  std::unique_ptr<Player> player;
  std::map<std::string, Place, std::less<>> states;
  std::unique_ptr<Recording> recording;  // null: none is running

  std::vector<Action> actions;  // of a request; kept for their memory
  ActWork act;
  BranchWork branch;
  MachinesWork machines;

  void check_frames(std::int64_t acts) const;  // throws Refusal when a request asks for too many
  void check_reply(std::size_t bytes, const std::string& about) const;  // throws Refusal when it is too long
  void start(Work& work) { work_ = &work; }                             // what a handler can't do at once
  void admit();                                                         // a token was right
  void count(const Outcome& outcome);                                   // into the statistics
  void watch();  // the machine, for the recording if there is one

  bool run(int frames);
  std::string_view whole_replies() const;  // not the one that is being worked on: it may yet be refused
  void sent(std::size_t count);            // of them
  bool wants_more() const;                 // see LineSession
  bool finished() const { return done_; }
  void cancel();
  void rest();

 private:
  bool has_enough() const;
  bool pauses() const;
  bool go_on();
  void take(const LineReader::Line& line);
  void begin_request();
  void execute(std::string_view line);
  void finish_reply();
  void measure();
  template <typename Step>
  void guarded(Step step);  // an exception becomes an error reply

  std::vector<std::string_view> words_;
  std::size_t reply_ = 0;  // where in `out` the current reply begins
  int unsent_ = 0;         // whole replies in `out`
  int unsent_frames_ = 0;  // that they took
  Work* work_ = nullptr;   // what is left of the current request
  int frames_left_ = 0;    // of this slice
  bool done_ = false;

  // For those who watch the server; null: nobody does.
  Meter* meter_;
  std::size_t command_ = 0;  // of the request: its row in commands()
  bool refused_ = false;
  std::chrono::steady_clock::time_point began_;
  std::int64_t metered_frames_ = 0;
};

}  // namespace racebeam
