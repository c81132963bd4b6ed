// The threads that encode and write recordings and logs, for a whole server or any number of sessions.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "recording/log_writer.hpp"
#include "recording/recording.hpp"

namespace racebeam {

class Recorder {
 public:
  // The folder must exist. most_files: of recordings and units of logs that are not finished. A unit counts
  // as a file, and so does a folder of pictures.
  explicit Recorder(std::string folder, std::size_t most_files = Claims::kNoLimit);
  ~Recorder();  // finishes all recordings, however long it takes, unless end() aborted them
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  // Begins to record `machine` under `name`, in a file for each kind. Does not wait for the disk. The caller
  // waits while the recording's is_behind() is true. If the recording has finished() then, the system refused
  // to write. To release the recording is the same as finish(); the Recorder must outlive it. `charge`, if
  // not null, is charged for the recording's memory until all is written. Throws std::runtime_error if a
  // recording of that name runs already, or if there would be too many files. Thread-safe.
  std::shared_ptr<Recording> begin(std::vector<MediaKind> kinds, const std::string& name,
                                   std::size_t most_bytes, const Environment& machine,
                                   const Charge& charge = {});

  // Begins a unit of the submission in the folder `name`, and sets the path of the order. Otherwise, it is
  // like begin().
  std::shared_ptr<LogWriter> begin_log(const std::string& name, SubmissionOrder order,
                                       std::size_t most_bytes);

  bool idle() const;  // whether all recordings have finished; thread-safe

  // Waits up to `patience` for all recordings to finish, then aborts the others. Removes files that were not
  // committed; they remain where the system hangs. After it, begin() must not be called.
  void end(std::chrono::milliseconds patience);

 private:
  class Threads;
  bool wait(std::chrono::milliseconds patience) const;  // waits until it is idle; false: the time is over

  const std::string folder_;
  const std::shared_ptr<Claims> claims_;
  const std::shared_ptr<std::atomic<bool>> given_up_ = std::make_shared<std::atomic<bool>>(false);
  std::unique_ptr<Threads> threads_;
};

}  // namespace racebeam
