// Where the lines of the log go: standard error, which may be a pipe that nobody empties, or a file on a disk
// that hangs. No thread that serves ever waits for it: what it has no room for waits here, up to a limit,
// beyond which the oldest lines are lost and counted. The system can't tell whether a file has room: a thread
// of its own writes it.
#pragma once

#include <spdlog/sinks/base_sink.h>
#include <sys/types.h>

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

namespace racebeam {

class LogSink final : public spdlog::sinks::base_sink<std::mutex> {
 public:
  static constexpr std::size_t kMostWaiting = 1024;  // lines

  enum class Kind { kFile, kSocket, kOther };  // of what is behind a descriptor
  static Kind kind_of(int descriptor);

  // `tell` makes the sentence, in the log's format, that tells how many lines were lost.
  static std::shared_ptr<LogSink> start(int descriptor, Kind kind,
                                        std::function<std::string(std::int64_t)> tell);

  void close();                                // at the end: gives what waits one more moment
  std::int64_t lost() const { return lost_; }  // lines, from any thread

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override;
  void flush_() override;  // writes what there is room for

 private:
  LogSink(int descriptor, Kind kind, std::function<std::string(std::int64_t)> tell);

  void write_file();  // until it is closed
  void add(const spdlog::details::log_msg& message);
  void lose_oldest();
  void tell_of_lost();
  bool has_room() const;
  bool write(std::string& line);  // false: no room; what was not written is left in it
  ssize_t write_some(const std::string& line) const;

  const int descriptor_;
  const Kind kind_;
  const std::function<std::string(std::int64_t)> tell_;
  std::deque<std::string> waiting_;
  bool begun_ = false;       // the first that waits is written in part
  std::int64_t untold_ = 0;  // lines that were lost since it was last told
  std::atomic<std::int64_t> lost_ = 0;

  // Of a file, under the mutex of the base.
  std::condition_variable changed_;
  bool writing_ = false, closed_ = false;
};

}  // namespace racebeam
