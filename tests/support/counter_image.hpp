// A cartridge for tests: its RAM records what an environment does to a machine.
#pragma once

#include <memory>
#include <string>

#include "games/game/game.hpp"
#include "games/rom_image.hpp"

namespace racebeam::test {

// 4 KiB. Clears $80-$9F when it starts; then, once a frame:
//   $80 counts frames, $81 and $82 show SWCHA and SWCHB, $83 and $84 the fire buttons (INPT4, INPT5: bit 7),
//   $85 counts frames with SELECT held, $86 those with RESET held; background and sound follow $80.
std::shared_ptr<const Image> counter_image();

// $80 after a reset of `frames` frames: the first frame ends before it counts.
constexpr int counted(int frames) { return (frames - 1) & 0xFF; }

// A game from the text of a game file without an image's MD5. The default game's rule is controlled by writes
// to RAM: $90 score, $91 over, $92 lives.
inline constexpr auto kSteeredGame = R"(
title = "Steered"
modes = [0, 1, 3]
difficulties = [0, 1, 2, 3]
[rule]
step = '''
score = ram[0x90]
terminal = ram[0x91] != 0
lives = ram[0x92]
'''
)";

std::shared_ptr<const Game> game(const std::string& text = kSteeredGame, const std::string& name = "steered");

}  // namespace racebeam::test
