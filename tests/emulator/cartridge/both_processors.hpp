// Plays a cartridge by the interpreter and by translated code, and compares both frame by frame.
#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <memory>

#include "emulator/console.hpp"
#include "emulator/translator/translator.hpp"
#include "tests/support/skip.hpp"

namespace racebeam::test {

// Requires that the program changes the byte `changed` of the cartridge's RAM.
inline void compare_processors(const Rom& image, const Properties& properties, std::size_t changed) {
  if (*Translator::obstacle() != '\0') return leave_out(Translator::obstacle());
  const auto rom = std::make_shared<const Rom>(image);
  SystemGenerator one(1), other(1);
  Console interpreted(rom, properties, one, CpuKind::kInterpreter),
      translated(rom, properties, other, CpuKind::kTranslator);
  for (int frame = 0; frame < 300; ++frame) {
    interpreted.step();
    translated.step();
    REQUIRE(interpreted.state().cycle == translated.state().cycle);
    REQUIRE(interpreted.state().cartridge.ram == translated.state().cartridge.ram);
    REQUIRE(std::ranges::equal(interpreted.cartridge_ram(), translated.cartridge_ram()));
  }
  CHECK(unsigned{interpreted.cartridge_ram()[changed]} > 0);
}

}  // namespace racebeam::test
