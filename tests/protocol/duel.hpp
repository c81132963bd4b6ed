// A game for two players that needs no image: the counting cartridge with its own rule, as `duel`.
#pragma once

#include "tests/games/scratch.hpp"
#include "tests/protocol/line_client.hpp"
#include "tests/support/counter_image.hpp"

namespace racebeam::test {

// Each frame with RIGHT held gives A one point and B three. Writing 17 (0x91) ends the game, and 18 (0x92)
// sets lives; 5 (0x85) shows the mode.
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

// A service with this image, besides the built-in ones. `duel_pal` is the same with the other television
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
