// The contents of a saved state; saved_state_format.hpp has its portable form.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "emulator/base/mersenne_twister.hpp"
#include "emulator/state/properties.hpp"
#include "emulator/state/state.hpp"
#include "emulator/tia/frame_buffer.hpp"
#include "emulator/tia/sound.hpp"
#include "environment/environment.hpp"
#include "environment/episode_state.hpp"
#include "environment/same_state.hpp"
#include "games/game/rule.hpp"

namespace racebeam {

// Identifies the image and the game of a state.
struct Identity {
  std::array<char, 32> md5{};
  std::array<char, 64> game{};  // its name, padded with zeros

  Identity() = default;
  Identity(const Image& image, const Game& its_game);

  std::string md5_text() const;
  std::string game_name() const;
  bool operator==(const Identity&) const = default;
};

class Environment::Saved {
 public:
  struct Values {
    State machine;
    EpisodeState play;
    RuleState rule;
    Sound sound;
    std::array<std::uint8_t, kAudioSize> audio{};
  };

  Identity identity;
  Values values;
  std::vector<std::uint8_t> cartridge_ram;        // Console::cartridge_ram()
  Properties properties;                          // the console's
  FrameBuffers pictures;                          // shared with the console until it draws on them
  int height = 0;                                 // visible rows of the pictures
  std::shared_ptr<const MersenneTwister> random;  // null: a state without its generator

  // See Environment::state_hash() and same_state(). States of different images are never the same.
  std::uint64_t state_hash() const { return racebeam::state_hash(parts()); }
  bool same_state(const Saved& other) const {
    return identity == other.identity && racebeam::same_state(parts(), other.parts());
  }

 private:
  StateParts parts() const { return {values.machine, values.play, values.rule, cartridge_ram}; }
};

static_assert(std::is_trivially_copyable_v<Environment::Saved::Values>);

// Throws InvalidInput if the identity of a saved state differs from that of the running machine.
void check_identity(const Identity& saved, const Identity& running);

}  // namespace racebeam
