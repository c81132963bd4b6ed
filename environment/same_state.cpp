#include "environment/same_state.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include "emulator/state/state_hash.hpp"

namespace racebeam {
namespace {

// The part of EpisodeState that decides the future, as words. It distinguishes -0.0 and 0.0, which does no
// harm.
using PlayWords = std::array<std::uint32_t, 8>;
PlayWords words_of(const EpisodeState& play) {
  const auto word = [](auto value) { return std::bit_cast<std::uint32_t>(value); };
  return {word(play.held.a.action), word(play.held.a.strength),
          word(play.held.b.action), word(play.held.b.strength),
          word(play.paddles[0]),    word(play.paddles[1]),
          word(play.mode),          word(play.switches)};
}

}  // namespace

std::uint64_t state_hash(const StateParts& parts) {
  StateHash hash;
  hash.add(parts.machine);
  hash.add(parts.rule.values);
  hash.add(words_of(parts.play));
  if (!parts.cartridge_ram.empty()) hash.add(parts.cartridge_ram);
  return hash.value();
}

bool same_state(const StateParts& a, const StateParts& b) {
  return std::memcmp(&a.machine, &b.machine, sizeof(State)) == 0 && a.rule == b.rule &&
         words_of(a.play) == words_of(b.play) && std::ranges::equal(a.cartridge_ram, b.cartridge_ram);
}

}  // namespace racebeam
