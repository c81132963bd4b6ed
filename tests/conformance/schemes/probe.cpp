// A machine whose RAM can be written between frames, for compare.py. Each line of input is a frame, before
// which the named bytes are written ("INDEX VALUE INDEX VALUE ..."), or "reset". The answer is the RAM in
// hexadecimal, and a checksum of the screen.
#include <zlib.h>

#include <cstdio>
#include <exception>
#include <iostream>
#include <sstream>
#include <string>

#include "environment/environment.hpp"
#include "games/catalogue.hpp"

namespace {

void poke(racebeam::Environment& environment, const std::string& line) {
  std::istringstream words(line);
  for (int index = 0, value = 0; words >> index >> value;)
    environment.set_ram(index, static_cast<std::uint8_t>(value));
}

void answer(const racebeam::Environment& environment) {
  for (const unsigned byte : environment.ram()) std::printf("%02x", byte);
  const auto screen = environment.screen();
  std::printf(" %08lx\n", crc32(0, screen.data(), static_cast<uInt>(screen.size())));
  std::fflush(stdout);
}

void converse(const std::string& image, const std::string& game) {
  const auto cartridge = racebeam::load_image(image);
  racebeam::Environment environment(cartridge, racebeam::recognise(*cartridge, game, {}).game, {});
  answer(environment);
  for (std::string line; std::getline(std::cin, line);) {
    if (line == "reset") {
      environment.reset_game();
    } else {
      poke(environment, line);
      environment.act(0);
    }
    answer(environment);
  }
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 3) throw std::invalid_argument("usage: probe IMAGE GAME");
  converse(argv[1], argv[2]);
} catch (const std::exception& error) {
  std::cerr << "probe: " << error.what() << '\n';
  return 1;
}
