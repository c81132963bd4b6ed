// One of the two frame buffers, and which line each of its rows shows (line_cache.hpp).
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "emulator/base/large_pages.hpp"
#include "emulator/state/state.hpp"
#include "emulator/tia/line_cache/line_record.hpp"
#include "emulator/tia/recorded_step.hpp"

namespace racebeam {

// Rows that have never been drawn are black, and allocate no memory.
class FrameBuffer {
 public:
  FrameBuffer() = default;
  // Copies a buffer into memory of this paging.
  FrameBuffer(const FrameBuffer& other, Paging paging)
      : undrawn(other.undrawn),
        is_undrawn(other.is_undrawn),
        rows_(other.rows_, paging),
        shows_(other.shows_, paging) {}

  // All rows, one after the other: those of the window, and those that a reset may have shifted it down by
  // (docs/spec/tia.md, 2).
  std::span<std::uint8_t> pixels() {
    return {reinterpret_cast<std::uint8_t*>(rows_.data()), sizeof(Row) * rows()};
  }
  std::span<const std::uint8_t> pixels() const {
    return {reinterpret_cast<const std::uint8_t*>(rows_.data()), sizeof(Row) * rows()};
  }

  std::size_t rows() const { return rows_.size(); }
  void make_room(std::size_t rows) {
    if (rows <= rows_.size()) return;
    shows_.resize(rows, kAnyLine);  // first: if memory runs out, a row without its number must not exist
    rows_.resize(rows);
  }

  void blank() {
    rows_.clear();
    shows_.clear();
    is_undrawn = false;
  }

  // Releases the memory of rows that will be drawn anew.
  void release_rows() {
    if (!is_undrawn) return;
    rows_ = MachineVector<Row>(rows_.get_allocator());
    shows_ = MachineVector<LineNumber>(shows_.get_allocator());
  }

  // Bytes of memory.
  std::size_t footprint() const {
    return sizeof(Row) * rows_.capacity() + sizeof(LineNumber) * shows_.capacity() +
           sizeof(undrawn.writes[0]) * undrawn.writes.capacity();
  }

  LineNumber& shows(std::size_t row) { return shows_[row]; }
  std::span<const LineNumber> lines() const { return shows_; }

  // Makes a row show `line`, by a copy from `other`. Returns false if that does not show it.
  bool copy_row(const FrameBuffer* other, std::size_t row, LineNumber line) {
    if (other == nullptr || row >= other->rows() || other->shows_[row] != line) return false;
    rows_[row] = other->rows_[row];
    shows_[row] = line;
    return true;
  }

  // Call it after another writer has changed pixels.
  void forget_lines() { std::ranges::fill(shows_, kAnyLine); }

  // The frame that this buffer shows, if it was run without its pixels. Replaying it fills all rows.
  RecordedStep undrawn;
  bool is_undrawn = false;

 private:
  struct alignas(32) Row : std::array<std::uint8_t, kLinePixels> {};
  static_assert(sizeof(Row) == kLinePixels);

  MachineVector<Row> rows_;
  MachineVector<LineNumber> shows_;
};

// Whether this is the only reference. A saved state may have been released by another thread, which had read
// the picture before.
inline bool is_own(const std::shared_ptr<FrameBuffer>& picture) {
  if (!picture || picture.use_count() > 1) return false;
#if defined(__SANITIZE_THREAD__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wtsan"  // it does not know fences
#endif
  std::atomic_thread_fence(std::memory_order_acquire);
  return true;
}

// The frame buffer drawn last, and the one before it.
struct FrameBuffers {
  std::shared_ptr<FrameBuffer> current, previous;
};

}  // namespace racebeam
