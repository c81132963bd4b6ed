// One of the two picture buffers, and for each of its rows what produced it: a row whose line starts with the same
// registers and meets the same writes need not be drawn, for its pixels are there already. The records are derived
// and belong to the buffer, not to the machine's state.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "emulator/line_record.hpp"
#include "emulator/sound.hpp"
#include "emulator/state.hpp"

namespace racebeam {

// A machine before a step that opens a frame, and has told the TIA so.
struct FrameStart {
  State state;
  std::vector<std::uint8_t> cartridge_ram;
  Sound sound;
};

struct Picture {
  static constexpr int kRows = 320;  // the window, and what a reset may shift it down by (tia.md, section 2)

  alignas(64) std::array<std::uint8_t, static_cast<std::size_t>(kRows) * kLinePixels> pixel{};
  std::vector<LineRecord> line;  // for each row of the window, once something has been drawn; or none

  // The last frame on this buffer was run without its pixels. From here it can be run again, and then fills them all.
  FrameStart undrawn;
  bool is_undrawn = false;

  // The pixels were written by somebody else.
  void forget_lines() {
    for (LineRecord& record : line) record.known = false;
  }
};

// The one drawn last, and the one before it.
struct Pictures {
  std::shared_ptr<Picture> current, previous;
};

}  // namespace racebeam
