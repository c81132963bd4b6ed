// The implementation of a LineSession: lines go in, and replies come out. It executes requests in slices of
// time.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/line/context.hpp"
#include "protocol/line/line_reader.hpp"
#include "protocol/line/meter.hpp"
#include "protocol/line/reply.hpp"

namespace racebeam {

struct CommandTable;

class Session {
 public:
  // All arguments must outlive the session. `counting` may be null. budget: of the session's memory; null:
  // the service's.
  Session(const LineService& service, const CommandTable& table, Meter* counting,
          const std::shared_ptr<MemoryBudget>& budget = nullptr);
  ~Session();

  Context& context() { return context_; }
  LineReader& input() { return input_; }

  bool run(std::chrono::microseconds slice);
  Pacer::Clock::duration worked() const { return worked_; }
  std::string_view whole_replies() const;  // without that of a request in progress, which may still fail
  void sent(std::size_t count);            // removes this many bytes of them
  bool waits() const;                      // see LineSession
  bool finished() const { return done_; }
  bool refused() const { return context_.service.strict && context_.statistics.errors > 0; }
  void cancel();
  void leave() { context_.leave(); }  // the destructor, on any thread, only frees memory then
  void release_caches();

 private:
  using Clock = Pacer::Clock;

  bool has_enough() const;
  bool pauses() const;
  bool resume(Clock::time_point end);
  std::optional<LineReader::Line> next_line();
  bool ignores(const LineReader::Line& line);
  void begin_request();
  void take(const LineReader::Line& line);
  void execute(std::string_view line);
  void read_words(std::string_view line);
  void refuse_http();
  void renew_words(const Command& command);
  std::string_view keep_word(std::string word);
  void report_old(const OldWord& row);
  void refuse(ErrorCode code, std::string_view sentence);
  void refuse_fault(const std::string& what);
  std::size_t footprint() const;
  void release();
  void finish_reply();
  void measure();
  template <typename Step>
  void guarded(Step step);  // an exception becomes an error reply

  Context context_;
  LineReader input_;
  Reply reply_;
  const CommandTable& table_;
  std::vector<std::string_view> words_;
  std::deque<std::string> new_words_;  // in the place of old ones
  std::int64_t sent_frames_ = 0;       // pacer.frames() when output was last sent
  std::int64_t sent_requests_ = 0;     // statistics.requests at the same time
  bool done_ = false;
  Clock::time_point began_;   // when the current request began
  Clock::time_point looked_;  // when the clock was last read
  Clock::duration worked_{};  // duration of the last run()

  // The server's metrics; null if it keeps no metrics.
  Meter* meter_;
  std::size_t command_ = 0;  // row of the request's command in the table
  bool refused_ = false;
  std::int64_t metered_frames_ = 0;
};

}  // namespace racebeam
