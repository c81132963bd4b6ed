// Logs of episodes on their way to the disk: a thread of the Recorder writes what a session has played.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "recording/recording.hpp"
#include "recording/submission_folder.hpp"

namespace racebeam {

class LogWriter : public std::enable_shared_from_this<LogWriter> {
 public:
  struct Result {
    int logged = 0;
    std::size_t bytes = 0;
    std::string failure;  // the system's error, as a sentence
  };

  // Recorder::begin_log() calls it. When `given_up` is set, no more logs are written.
  LogWriter(SubmissionOrder order, std::size_t most_bytes, std::unique_ptr<Claim> claim, Recording::Post post,
            std::shared_ptr<const std::atomic<bool>> given_up);
  void begin();

  // Whether the last call has not been completed. The caller waits until it has. Thread-safe.
  bool is_behind() const;

  // Must not be called while is_behind(). Does nothing after a cut. `charge` is released when the log is
  // written.
  void add(EpisodeLog log, std::shared_ptr<const void> charge);

  void finish();                                    // after the last log
  bool finished() const;                            // all work is done; thread-safe
  std::optional<Recording::Cut> cut() const;        // why no more logs are written; thread-safe
  const Result& result() const { return result_; }  // not while is_behind()
  const std::string& name() const { return name_; }

 private:
  // On the recorder's threads:
  void open();
  void write(const EpisodeLog& log);
  void close();
  void cut_off(Recording::Cut why, const std::string& failure);

  void post(std::function<void()> job);

  const std::string name_;
  const Recording::Post post_;

  // Used by the recorder's threads:
  SubmissionOrder order_;
  DiskBudget budget_;
  std::unique_ptr<SubmissionFolder> folder_;  // null: nothing more is written
  std::unique_ptr<Claim> claim_;
  Result result_;

  mutable std::mutex mutex_;
  int waiting_ = 0;  // jobs
  bool finishing_ = false, ended_ = false;
  std::optional<Recording::Cut> cut_;
};

}  // namespace racebeam
