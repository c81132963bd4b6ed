// The threads that encode and write recordings and logs, for a whole server or any number of sessions.
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "recording/log_writer.hpp"
#include "recording/recording.hpp"

namespace racebeam {

class Recorder {
 public:
  explicit Recorder(std::string folder);  // the folder must exist
  ~Recorder();  // finishes all recordings, however long it takes, unless end() aborted them
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  // Begins to record `machine` under `name`, a file for each kind.
  // The caller waits while is_behind(). If the recording has then finished(), the system refused to write.
  // Releasing it is the same as finish(); the Recorder must outlive it. `charge`, if not null, is charged for
  // its memory until all is written.
  // It never waits for the disk. It throws std::runtime_error if a recording of that name runs already. It is
  // thread-safe.
  std::shared_ptr<Recording> begin(std::vector<MediaKind> kinds, const std::string& name,
                                   std::size_t most_bytes, const Environment& machine,
                                   const Charge& charge = {});

  // Begins a unit of the submission in the folder `name`. The path of the order is set here. All else is as
  // with begin().
  std::shared_ptr<LogWriter> begin_log(const std::string& name, SubmissionOrder order,
                                       std::size_t most_bytes);

  bool idle() const;  // all recordings have finished; thread-safe

  // Waits up to `patience` for all recordings to finish, then aborts them. Files that were not committed are
  // removed, or remain where the system hangs. No more recordings are begun.
  void end(std::chrono::milliseconds patience);

 private:
  class Threads;
  bool wait(std::chrono::milliseconds patience) const;  // until it is idle; false: the time is over

  const std::string folder_;
  const std::shared_ptr<Claims> claims_ = std::make_shared<Claims>();
  const std::shared_ptr<std::atomic<bool>> given_up_ = std::make_shared<std::atomic<bool>>(false);
  std::unique_ptr<Threads> threads_;
};

}  // namespace racebeam
