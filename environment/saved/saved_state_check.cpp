#include "environment/saved/saved_state_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "emulator/base/range_check.hpp"
#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

constexpr int kMaxInt = std::numeric_limits<std::int32_t>::max();
constexpr int kSlowestDivider = 31;  // AUDFx has five bits

void check_offered(const char* what, int number, const std::vector<int>& offered) {
  if (std::ranges::find(offered, number) != offered.end()) return;
  std::string list;
  for (const int one : offered) list += (list.empty() ? "" : ", ") + std::to_string(one);
  refuse_field(what, number, "one of " + list);
}

void check_strength(const Press& press) {
  if (!std::isfinite(press.strength))
    throw InvalidInput("invalid state: the strength of a held action is not a finite number");
}

}  // namespace

// A held action may be any number: with paddles the client may send any, and an unknown one presses nothing.
void check_play(const EpisodeState& play, const Game& game) {
  check_strength(play.held.a);
  check_strength(play.held.b);
  for (const std::int32_t ohms : play.paddles) check_range("a turned paddle", ohms, 0, kMaxInt);
  check_range("the frame number", play.frames, 0, kMaxInt);
  check_range("the frame number of the episode", play.episode_frames, 0, kMaxInt);
  check_offered("the mode", play.mode, game.offered_modes());
  const auto [difficulty, moved] = play.switches;
  if (difficulty != 0) check_offered("the difficulty", difficulty, game.difficulties);  // starts with 0
  check_range("the switches that actions have moved", moved, 0,
              ConsoleSwitches::kDifficulty | ConsoleSwitches::kBlackAndWhite);
  check_flag("the flag of outdated RAM", play.ram_is_stale);
}

void check_rule_state(const RuleState& state, const Game& game) {
  const std::size_t used = game.rule ? game.rule->variables.size() : 0;
  for (std::size_t i = used; i < state.values.size(); ++i)
    check_range("a variable that the rule does not have", state.values[i], 0, 0);
}

void check_sound(const Sound& sound) {
  for (const Sound::Channel& channel : sound.channel)
    check_range("the divider of a sound channel", channel.divider, 0, kSlowestDivider);
}

// A generator whose words are all zero would return only zeros.
void check_generator(std::span<const std::uint32_t, MersenneTwister::kWords> words, std::uint32_t position) {
  check_range("the position of the generator", position, 0, MersenneTwister::kWords);
  if (std::ranges::all_of(words, [](std::uint32_t word) { return word == 0; }))
    throw InvalidInput("invalid state: the words of the generator are all 0");
}

}  // namespace racebeam
