// Games from a few lines of text, and memory for their rules.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "games/files/game_file.hpp"

namespace racebeam {

// RAM, and bytes elsewhere on the bus that are the low byte of their address.
struct FakeMemory {
  std::array<std::uint8_t, 128> ram{};

  std::uint8_t& operator[](int address) { return ram.at(static_cast<std::size_t>(address - 0x80)); }
  Memory memory() const { return {ram.data(), peek, this}; }
  static std::uint8_t peek(const void*, std::uint16_t address) { return static_cast<std::uint8_t>(address); }
};

inline Game game_with(const std::string& lines) {
  return parse_game("title = 'Test'\n" + lines, "test", "test.toml");
}

inline Game game_with_step(const std::string& step, const std::string& more = "") {
  return game_with("[rule]\n" + more + "\nstep = '''\n" + step + "\n'''");
}

}  // namespace racebeam
