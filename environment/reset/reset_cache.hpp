// Resets as copies. A reset runs 60 to 100 frames from a machine that was just switched on. They are the same
// whenever they start from the same state. The state at their end is therefore cached under the state at
// their start.
//
// Starts differ in what the previous episode left in RAM, in the timer, which is random, and in the sound
// registers. Most programs overwrite these before they read them. Where that is proven (boot_analysis.hpp),
// they are left out of the comparison. The rest of the machine is compared byte for byte, so that a copy
// always equals the result of running the reset.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "emulator/state/properties.hpp"
#include "emulator/state/state.hpp"
#include "emulator/tia/frame_buffer.hpp"
#include "environment/input/paddles.hpp"
#include "games/game/rule.hpp"

namespace racebeam {

struct Game;
struct Image;

// Everything that determines the result of a reset.
struct ResetStart {
  std::shared_ptr<const Image> image;  // compared by address
  std::shared_ptr<const Game> game;
  PaddleLimits limits;
  std::int32_t mode = 0, difficulty = 0;
  std::array<std::uint8_t, 6> sound{};  // registers
  State machine;                        // after the system reset
  Format format = Format::kNtsc;        // random contents at power-on may have decided what was detected

  std::uint64_t hash() const;
  bool operator==(const ResetStart& other) const;
};

struct ResetEnd {
  State machine;
  std::array<std::uint8_t, 6> sound{};
  RuleState rule;
  PaddleValues paddles{};
  std::uint32_t frames = 0;  // frames of the reset that Environment::frame_number() counts
  FrameBuffers pictures;
};

class ResetCache {
 public:
  static constexpr std::size_t kMax = 128;  // entries; an entry takes some 70 KiB, mostly the two pictures

  // At least 1 entry. Drops the entries that were not used for longest, if there are more.
  void set_capacity(std::size_t entries);

  std::optional<ResetEnd> find(const ResetStart& start);
  // Keeps copies of the pictures. If the cache is full, replaces the entry that was not used for longest.
  void keep(const ResetStart& start, ResetEnd end);
  std::size_t size();

 private:
  struct Entry {
    std::uint64_t hash;
    std::uint64_t used;  // the number of the call that used it last
    ResetStart start;
    ResetEnd end;
  };

  void shrink_to(std::size_t entries);

  std::mutex mutex_;
  std::size_t capacity_ = kMax;
  std::uint64_t calls_ = 0;
  std::vector<Entry> entries_;
};

// The cache of all machines of the process. Thread-safe.
ResetCache& reset_cache();

}  // namespace racebeam
