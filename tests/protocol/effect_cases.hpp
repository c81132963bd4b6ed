// The cases of effect_test.cpp: a pair of conversations for each row of the program's tables.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace racebeam::test {

// Two conversations that differ only in what `row` names. Both end with `probe`, and its replies must differ.
// Without a probe, the replies to their own last lines must differ.
struct Case {
  std::string_view row;
  std::string one, other, probe = "";
};

using Cases = std::vector<Case>;

// A conversation that loads the game duel, and a token.
extern const std::string kLoadDuel, kToken;

// A cartridge image as base64. `unused_byte` changes its MD5.
std::string counter_as_text(int unused_byte = 0);

// Commands and words of their arguments, "COMMAND" and "COMMAND WORD".
const Cases& cases_without_game();
const Cases& cases_with_duel();  // after kLoadDuel

const Cases& cases_of_settings();  // of `load`

}  // namespace racebeam::test
