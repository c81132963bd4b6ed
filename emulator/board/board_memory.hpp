// What translated code addresses: the members of a Board at offsets that are the same for all boards
// (emulator/translator/layout.hpp).
#pragma once

#include <array>
#include <cstdint>

#include "emulator/board/context.hpp"
#include "emulator/cartridge/cartridge.hpp"
#include "emulator/cartridge/memory_map.hpp"
#include "emulator/state/state.hpp"
#include "emulator/tia/sound.hpp"

namespace racebeam {

// The first members are addressed most often. An offset below 128 makes instructions of x86-64 shorter.
struct BoardMemory {
  BoardMemory(const Rom& rom, const Scheme& scheme) : slot{rom, scheme, state, {}, map} {}

  translator::Context translator_context;
  // The cycle of the last TIA access that was not a plain write: the picture is drawn up to there.
  std::int32_t last_access = 0;
  bool stop = false;  // the CPU stops after this instruction: the frame has closed, or must be run again
  // The first cycle in which each of INPT0-5 reads high. The two addresses after them never do.
  std::array<std::uint32_t, 8> pin_high_from{};
  CodeWindow code;  // where the CPU fetches; empty after the map has changed or the frame has closed
  State state;
  MemoryMap map;
  Sound sound;
  CartridgeSlot slot;
};

}  // namespace racebeam
