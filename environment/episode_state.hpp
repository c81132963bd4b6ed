// The data that persists from act to act beside the machine and the state of the rule. One trivially copyable
// value, so that saving it is a copy and nothing can be left out.
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include "environment/input/console_switches.hpp"
#include "environment/input/effective_actions.hpp"
#include "environment/input/paddles.hpp"

namespace racebeam {

struct EpisodeState {
  Presses held;  // what a sticky frame repeats
  PaddleValues paddles{};
  std::uint32_t frames = 0;  // counted since loading
  std::uint32_t episode_frames = 0;
  std::int32_t mode = 0;  // takes effect at the next reset
  ConsoleSwitches switches;
  std::array<std::int32_t, 2> rewards{};  // of the last act: A's and B's
  std::uint32_t ram_is_stale = 0;         // ram() returns the next member: Environment::restore_classic()
  std::array<std::uint8_t, 128> stale_ram{};
};

static_assert(std::is_trivially_copyable_v<EpisodeState>);

}  // namespace racebeam
