// The destination of the log: standard error. It may be a pipe without a reader, or a file on a hanging disk.
// Threads that serve never wait for it. Lines that cannot be written yet are queued, up to a limit; beyond
// it, the oldest lines are dropped and counted. The system cannot tell whether a file has room, so a file has
// a thread that writes it.
#pragma once

#include <spdlog/sinks/base_sink.h>

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "system/program/standard_streams.hpp"

namespace racebeam {

class LogSink final : public spdlog::sinks::base_sink<std::mutex> {
 public:
  static constexpr std::size_t kMaxWaiting = 1024;  // lines

  // loss_text: makes the line, in the log's format, that reports how many lines were lost.
  static std::shared_ptr<LogSink> start(int descriptor, OutputKind kind,
                                        std::function<std::string(std::int64_t)> loss_text);

  void close();                                // at the end: waits for a moment for the remaining lines
  std::int64_t lost() const { return lost_; }  // lines; thread-safe

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override;
  void flush_() override;  // writes as much as there is room for

 private:
  LogSink(int descriptor, OutputKind kind, std::function<std::string(std::int64_t)> loss_text);

  void write_file();  // until the sink is closed
  void add(const spdlog::details::log_msg& message);
  void lose_oldest();
  void report_lost();
  bool write(std::string& line);  // returns false if it is full; the rest of the line stays in it

  const int descriptor_;
  const OutputKind kind_;
  const std::function<std::string(std::int64_t)> loss_text_;
  std::deque<std::string> waiting_;
  bool has_begun_ = false;       // a part of the first line that waits has been written
  std::int64_t unreported_ = 0;  // lines lost since the last report
  std::atomic<std::int64_t> lost_ = 0;

  // For a file; under the mutex of the base.
  std::condition_variable changed_;
  bool writing_ = false, closed_ = false;
};

}  // namespace racebeam
