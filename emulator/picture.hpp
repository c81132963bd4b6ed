// One of the two picture buffers, and for each of its rows what produced it: a row whose line starts with the same
// registers and meets the same writes need not be drawn, for its pixels are there already. The records are derived
// and belong to the buffer, not to the machine's state.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "emulator/line.hpp"
#include "emulator/line_key.hpp"
#include "emulator/state.hpp"

namespace racebeam {

struct LineRecord {
  static constexpr std::uint8_t kInvalid = 0xFF;

  TiaRegisters start;              // at the line's first clock
  Collisions meetings;             // pairs that met on the line, after the last CXCLR
  LineView view;                   // what of `start` counts
  std::uint8_t count = kInvalid;   // of events
  std::uint8_t comb_armed;         // what the line left
  std::uint8_t enabled;            // the same; of a line that is kLit
  std::uint8_t has_pixels;         // the buffer's row is this line; else only the rest is known
  std::array<std::uint32_t, 17> event;  // the writes: TiaWrite, with cycles from the line's first on; read by fours
};
static_assert(sizeof(LineRecord) == 128);

// A machine before a step that opens a frame, and has told the TIA so.
struct FrameStart {
  State state;
  std::vector<std::uint8_t> cartridge_ram;
};

struct Picture {
  static constexpr int kRows = 320;  // the window, and what a reset may shift it down by (tia.md, section 2)
  static constexpr int kRecordedRows = 250;  // of the tallest picture that games have

  alignas(64) std::array<std::uint8_t, static_cast<std::size_t>(kRows) * kLinePixels> pixel{};
  std::array<LineRecord, kRecordedRows> line;
  std::array<std::uint32_t, 4> beyond_last_event{};  // of the last record

  // The last frame on this buffer was run without its pixels. From here it can be run again, and then fills them all.
  FrameStart undrawn;
  bool is_undrawn = false;

  // The pixels were written by somebody else.
  void forget_lines() {
    for (LineRecord& record : line) record.count = LineRecord::kInvalid;
  }
};

// The one drawn last, and the one before it.
struct Pictures {
  std::shared_ptr<Picture> current, previous;
};

}  // namespace racebeam
