// What `record` has begun: each frame of an act goes to the disk until `record stop`, or the session's end.
#pragma once

#include <memory>
#include <string>

#include "emulator/sound.hpp"
#include "environment/environment.hpp"
#include "recording/media.hpp"

namespace racebeam {

class Recording {
 public:
  // Throws std::runtime_error when the disk refuses.
  Recording(MediaKind kind, const std::string& folder, const std::string& name, std::size_t most_bytes,
            const Environment& machine);
  ~Recording();  // keeps what there is
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  // One frame. When the disk refuses there are no more, and stop() says why.
  void add(const Environment& machine) noexcept;

  void stop();  // throws std::runtime_error
  const std::string& name() const { return name_; }
  int frames() const { return frames_; }
  std::size_t bytes() const { return budget_.taken(); }

 private:
  std::string name_;
  DiskBudget budget_;
  std::unique_ptr<Media> media_;  // null when it has ended
  Sound sound_;                   // of its own: what is recorded must not change what is played
  int frames_ = 0;
  std::string failure_;
};

}  // namespace racebeam
