// The implementation of a LineSession, and the context of its commands.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "emulator/translator/code_owner.hpp"
#include "protocol/line/line_reader.hpp"
#include "protocol/line/line_service.hpp"
#include "protocol/line/loaded_machine.hpp"
#include "protocol/line/machines.hpp"
#include "protocol/line/meter.hpp"
#include "protocol/line/states.hpp"
#include "protocol/line/watching.hpp"
#include "protocol/running/memory_budget.hpp"
#include "protocol/running/pacer.hpp"

namespace racebeam {

struct Command;
struct CommandTable;
class Recording;
class SessionRecording;

// Frames that a machine may run beyond those of the request. Power-on and an ordinary reset take about 130.
constexpr std::int64_t kFreeResetFrames = 1000;

struct Statistics {
  std::int64_t requests = 0, errors = 0, acts = 0, frames = 0, episodes = 0, bytes_in = 0, bytes_out = 0;
};

class Session {
 public:
  // All arguments must outlive the session. `counting` may be null. budget: of the session's memory; null:
  // the service's.
  Session(const LineService& with, const CommandTable& table, Meter* counting,
          const std::shared_ptr<MemoryBudget>& budget = nullptr);
  ~Session();

  const LineService& service;
  LineReader input;
  std::string out;
  std::string raw;  // bytes that follow the line of the current reply
  bool quitting = false;
  bool admitted;         // the client gave a valid token, or none is needed
  int wrong_tokens = 0;  // how many the client gave
  int columns = 0;       // width of the terminal if a person types; 0: the client is a program
  Statistics statistics;
  Pacer pacer;  // each request runs as its body

  // The loaded game. `loaded` is null if there is none.
  Cartridge cartridge;
  std::unique_ptr<CodeOwner> own_image;  // null: the image is the server's
  PlaySettings settings;
  std::vector<Field> fields;  // selected by `observe`; they persist across `load`
  std::unique_ptr<LoadedMachine> loaded;
  States states;
  std::int64_t episode = 1;                     // of the loaded machine, from 1
  int last_action = 0;                          // of player A, played on it
  std::unique_ptr<SessionRecording> recording;  // null if nothing is being recorded
  std::shared_ptr<Recording> picture;           // that the request writes; null if it writes none
  std::unique_ptr<Sharing> sharing;             // null if the session is not shared
  Watching watching;                            // shared sessions that this one watches

  MemoryShare memory;           // of the server's budget; a request checks it before it allocates
  std::vector<Action> actions;  // of the current request; members to reuse their memory
  std::vector<Act> step_acts;   // the same for `step`
  Machines machines;

  // Throws RequestError if these acts, and these frames in addition, exceed --max-request-frames.
  void check_frames(std::int64_t acts, std::int64_t frames = 0) const;
  // Lets the request reset this many machines. The pacer then stops it at the frames that it may run.
  void allow_resets(std::size_t machines);
  // Throws RequestError if a reply of this estimated length would exceed the limit. `about` is its subject.
  void check_reply(std::size_t bytes, const std::string& about) const;
  void admit();                        // the client gave a valid token
  void count(const Outcome& outcome);  // adds it to the statistics
  void append_cut();                   // notes in the reply that the recording has ended early
  // Empties an object of about so many bytes, whose content is destroyed elsewhere if that takes long.
  template <typename T>
  void discard(T& object, std::size_t bytes) {
    dispose(service.disposal, service.memory, bytes, std::exchange(object, T()));
  }
  void discard(std::string& text);
  void stop_recording_machines();  // stops a recording of machines of `open`, which are about to go
  void run_parallel(std::size_t count, const std::function<void(std::size_t)>& task) const;

  bool run(std::chrono::microseconds slice);
  Pacer::Clock::duration worked() const { return worked_; }
  std::string_view whole_replies() const;  // without that of a request in progress, which may still fail
  void sent(std::size_t count);            // removes this many bytes of them
  bool waits() const;                      // see LineSession
  bool finished() const { return done_; }
  bool refused() const { return service.strict && statistics.errors > 0; }
  void cancel();
  void leave();  // ends all that others notice; the destructor, on any thread, only frees memory then
  void rest();

 private:
  using Clock = Pacer::Clock;

  bool has_enough() const;
  bool pauses() const;
  bool go_on(Clock::time_point end);
  std::optional<LineReader::Line> next_line();
  bool ignores(const LineReader::Line& line);
  void begin_request();
  void take(const LineReader::Line& line);
  void execute(std::string_view line);
  void read_words(std::string_view line);
  void renew_words(const Command& command);
  void report_old(const OldWord& row);
  void drop_reply();
  void refuse(ErrorCode code, std::string_view sentence);
  void refuse_fault(const std::string& what);
  std::size_t footprint() const;
  void release();
  void finish_reply();
  void publish();  // to watchers
  void measure();
  template <typename Step>
  void guarded(Step step);  // an exception becomes an error reply

  const CommandTable& table_;
  std::vector<std::string_view> words_;
  std::deque<std::string> new_words_;  // in the place of old ones
  std::size_t reply_ = 0;              // offset of the current reply in `out`
  std::int64_t sent_frames_ = 0;       // pacer.frames() when `out` was last sent
  std::int64_t sent_requests_ = 0;     // statistics.requests at the same time
  bool done_ = false;
  Clock::time_point began_;   // when the current request began
  Clock::time_point looked_;  // when the clock was last read
  Clock::duration worked_{};  // duration of the last run()

  // The server's metrics; null if it has none.
  Meter* meter_;
  std::size_t command_ = 0;  // row of the request's command in the table
  bool refused_ = false;
  std::int64_t metered_frames_ = 0;
};

}  // namespace racebeam
