// Resets as copies. A reset runs 60 to 100 frames from a machine that was just switched on, and these are the same
// whenever they start from the same state. So the state they lead to is kept, with what it came from, and
// copied when that comes again.
//
// Where a reset starts differs by what the episode before left in RAM, by the timer, which is random, and by the
// sound registers. Most programs overwrite these before they look at them; where that is proven (boot_study.hpp),
// they are left out of the comparison. All the rest of the machine is compared byte for byte, so that a copy is
// always what running would have given.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "emulator/state/state.hpp"
#include "emulator/tia/frame_buffer.hpp"
#include "environment/input/paddles.hpp"
#include "games/game/rule.hpp"

namespace racebeam {

struct Game;
struct Image;

// All that decides what a reset leads to.
struct ResetStart {
  std::shared_ptr<const Image> image;  // by identity
  std::shared_ptr<const Game> game;
  PaddleLimits limits;
  std::int32_t mode = 0, difficulty = 0;
  std::array<std::uint8_t, 6> sound{};  // registers
  State machine;  // after the system reset

  std::uint64_t hash() const;
  bool operator==(const ResetStart& other) const;
};

struct ResetEnd {
  State machine;
  std::array<std::uint8_t, 6> sound{};
  Tally tally;
  PaddleValues paddles{};
  std::uint32_t frames = 0;  // that were counted
  FrameBuffers pictures;
};

class ResetCache {
 public:
  static constexpr std::size_t kMost = 128;  // ends; of each the two pictures are the most

  std::optional<ResetEnd> find(const ResetStart& start);
  void keep(const ResetStart& start, const ResetEnd& end);  // in place of the one not used for longest
  std::size_t size();

 private:
  struct Entry {
    std::uint64_t hash;
    std::uint64_t used;  // when, in calls
    ResetStart start;
    ResetEnd end;
  };

  std::mutex mutex_;
  std::uint64_t calls_ = 0;
  std::vector<Entry> entries_;
};

// The cache that all machines of the process share. Can be called from any thread.
ResetCache& reset_cache();

}  // namespace racebeam
