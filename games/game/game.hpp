// A game's facts: images, actions, modes, and the rule that turns memory into reward.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "emulator/state/properties.hpp"
#include "games/game/actions.hpp"
#include "games/game/mode_program.hpp"
#include "games/game/rule.hpp"

namespace racebeam {

struct GameImage {
  std::string md5;        // lower-case hex; empty: any image
  Properties properties;  // what the console must know about this image
  bool accepted = true;   // false: another dump; it is not recognised as this game by its MD5
};

// The origin of the rule in a game file's [rule].
enum class RuleSource { kAle012, kRacebeam };

// A known error of the reference's rule, and its correction by --rules fixed ([fixed] in a game file).
struct Correction {
  std::optional<int> wraps;                     // rewards are counted across the score's wrap at this number
  std::string reference, correction, evidence;  // for the documents; empty if `wraps` suffices
};

struct Game {
  std::string name;  // snake case; also the file stem by which an unknown image is recognised
  std::string title;
  std::vector<GameImage> images;

  std::vector<int> legal_actions = all_actions();    // player A's numbers, ascending
  std::vector<int> minimal_actions = all_actions();  // the useful ones of these, ascending
  std::vector<int> starting_actions;                 // one frame each, after the mode program; 40 is RESET

  std::vector<int> modes{0};
  std::vector<int> two_player_modes;  // those in which player B plays too; may repeat some of `modes`
  int default_mode = 0;
  // Bit 0: left switch A; bit 1: right switch A. An environment starts with 0.
  std::vector<int> difficulties{0};
  int paddle_max = -1;  // a wider range of the paddles than usual; -1: the usual one

  std::optional<RuleProgram> rule;
  RuleSource rule_source = RuleSource::kAle012;
  ModeProgram mode_program;

  // The same game as in ALE 0.6, for classic sessions; null if it was the same.
  std::shared_ptr<const Game> classic;

  // The same game with the corrected rule; null if no error is known. `correction` is set with it.
  std::shared_ptr<const Game> fixed;
  bool is_fixed = false;  // whether this is a corrected game itself
  Correction correction;

  bool has_rule() const { return rule.has_value(); }
  bool has_second_reward() const { return rule && rule->reward_b; }
  std::vector<int> offered_modes() const;      // modes and two_player_modes, ascending
  bool accepts(const std::string& md5) const;  // whether the rule was written for this image
  Properties properties_for(const std::string& md5) const;
};

// The game of an unknown image: no score, all actions, both difficulty switches.
Game game_without_rule(const std::string& name);

}  // namespace racebeam
