// The threads that encode and write what is recorded: for a whole server, or for any number of sessions.
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "recording/recording.hpp"

namespace racebeam {

class Recorder {
 public:
  explicit Recorder(std::string folder);  // which exists
  ~Recorder();  // as many as there are are finished, however long it takes, unless end() gave them up
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  // Begins to record `machine` under `name`, a file for each kind. The caller waits while it is_behind();
  // when it has finished() by then, the disk refused. Letting go of it, before the Recorder goes, is as good
  // as finish(). Its memory is charged with `charge`, if there is one, until all is written. Never waits for
  // the disk; throws std::runtime_error when a recording of that name is under way. From any thread.
  std::shared_ptr<Recording> begin(std::vector<MediaKind> kinds, const std::string& name,
                                   std::size_t most_bytes, const Environment& machine,
                                   const Charge& charge = {});

  bool idle() const;  // all recordings have finished; from any thread

  // Waits so long for all recordings to finish; then it gives them up: what has not been kept is removed, or
  // left where the disk hangs. No more are begun.
  void end(std::chrono::milliseconds patience);

 private:
  class Threads;
  bool wait(std::chrono::milliseconds patience) const;  // until it is idle; false: it is not

  const std::string folder_;
  const std::shared_ptr<Claims> claims_ = std::make_shared<Claims>();
  const std::shared_ptr<std::atomic<bool>> given_up_ = std::make_shared<std::atomic<bool>>(false);
  std::unique_ptr<Threads> threads_;
};

}  // namespace racebeam
