// One of the two picture buffers, and which line each of its rows shows (line_cache.hpp).
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "emulator/state/state.hpp"
#include "emulator/tia/line_cache/line_record.hpp"
#include "emulator/tia/sound.hpp"

namespace racebeam {

// A machine before a step that opens a frame, and has told the TIA so.
struct FrameStart {
  State state;
  std::vector<std::uint8_t> cartridge_ram;
  Sound sound;
};

// Rows that have never been drawn are black, and take no memory.
class FrameBuffer {
 public:
  // All of its rows, one after the other: those of the window, and those that a reset has shifted it down by, if ever
  // (docs/spec/tia.md, 2).
  std::span<std::uint8_t> pixels() { return {reinterpret_cast<std::uint8_t*>(rows_.data()), sizeof(Row) * rows()}; }
  std::span<const std::uint8_t> pixels() const {
    return {reinterpret_cast<const std::uint8_t*>(rows_.data()), sizeof(Row) * rows()};
  }

  std::size_t rows() const { return rows_.size(); }
  void make_room(std::size_t rows) {
    if (rows <= rows_.size()) return;
    rows_.resize(rows);
    shows_.resize(rows, kAnyLine);
  }

  void blank() {
    rows_.clear();
    shows_.clear();
    is_undrawn = false;
  }

  LineNumber& shows(std::size_t row) { return shows_[row]; }

  // A row shows that line now, if the other picture does.
  bool copy_row(const FrameBuffer* other, std::size_t row, LineNumber line) {
    if (other == nullptr || row >= other->rows() || other->shows_[row] != line) return false;
    rows_[row] = other->rows_[row];
    shows_[row] = line;
    return true;
  }

  // The pixels were written by somebody else.
  void forget_lines() { std::ranges::fill(shows_, kAnyLine); }

  // The last frame on this buffer was run without its pixels. From here it can be run again, and then fills them all.
  FrameStart undrawn;
  bool is_undrawn = false;

 private:
  struct alignas(32) Row : std::array<std::uint8_t, kLinePixels> {};
  static_assert(sizeof(Row) == kLinePixels);

  std::vector<Row> rows_;
  std::vector<LineNumber> shows_;
};

// Nobody else holds it. A snapshot may have been let go in another thread, after it had looked at the picture.
inline bool is_own(const std::shared_ptr<FrameBuffer>& picture) {
  if (!picture || picture.use_count() > 1) return false;
#if defined(__SANITIZE_THREAD__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wtsan"  // fences are all the same to it
#endif
  std::atomic_thread_fence(std::memory_order_acquire);
  return true;
}

// The one drawn last, and the one before it.
struct FrameBuffers {
  std::shared_ptr<FrameBuffer> current, previous;
};

}  // namespace racebeam
