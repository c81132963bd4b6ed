// A game for two that always is at hand: the counting cartridge with a rule of its own, as `duel`.
#pragma once

#include "tests/games/scratch.hpp"
#include "tests/protocol/line_client.hpp"
#include "tests/support/counter_image.hpp"

namespace racebeam::test {

// Each frame with RIGHT held gives A one point and B three. Poking 17 (0x91) ends the game, and 18 (0x92)
// takes lives; 5 (0x85) shows the mode.
inline constexpr auto kDuel = R"(
title = "Duel"
minimal = ["NOOP", "FIRE", "RIGHT", "LEFT"]
modes = [0]
two_player_modes = [2]
difficulties = [0, 1, 2, 3]
[rule]
reset = { lives = 3 }
step = '''
reward = (ram[0x81] & 0x80) == 0
reward_b = 3 * ((ram[0x81] & 0x08) == 0)
terminal = ram[0x91] != 0
lives = 3 - ram[0x92]
'''
[mode]
setup = "while ram[0x85] < mode { select 1 }"
)";

// A service whose images have it, beside those that are built in; as `duel_pal` it has the other television
// standard.
inline LineService duel_service(const LineLimits& limits = {}) {
  const Scratch folder;
  const auto image = counter_image();
  const std::string bytes(image->bytes->begin(), image->bytes->end()), game = kDuel;
  auto images = std::make_shared<Images>();
  images->add_file(folder.write("duel.bin", bytes), std::nullopt, folder.write("duel.toml", game));
  images->add_file(folder.write("duel_pal.bin", bytes), std::nullopt,
                   folder.write("duel_pal.toml", game + "[[image]]\nformat = 'PAL'\n"));
  LineService service = line_service(limits);
  service.images = std::move(images);
  return service;
}

}  // namespace racebeam::test
