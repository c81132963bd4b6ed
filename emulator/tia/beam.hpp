// The beam draws the picture up to a colour clock, line by line, from the current registers
// (docs/spec/tia.md, 3, 5 and 6).
#pragma once

#include <algorithm>
#include <cstdint>

#include "emulator/base/inlining.hpp"
#include "emulator/state/state.hpp"
#include "emulator/tia/frame_buffer.hpp"
#include "emulator/tia/line/line.hpp"
#include "emulator/tia/line/pixels.hpp"
#include "emulator/tia/line_cache/line_cache.hpp"

namespace racebeam {

constexpr int kLineClocks = 228;
constexpr int kBlankClocks = 68;  // per line, before its first pixel

// How much of the picture a step makes.
enum class RenderMode : std::uint8_t {
  kNone,  // nothing: the pixels stay as they were
  kDrawn,
  // Each access on its own, as the reference draws, with the pixels beyond the end of a span
  // (docs/spec/tia.md, "Provisional pixels").
  kExact,
};

// The geometry of a console's picture; constant once its format is known.
struct Video {
  int ystart = 34;   // first line drawn
  int height = 210;  // lines drawn
  bool hmove_blanks = true;
  bool pal = false;  // loses its colour on odd line counts, and may have more lines
};

class Beam {
 public:
  Beam(TiaState& state, const Video& video);

  void begin_frame();  // moves the cursor to the start of the window

  // Sets the target of the next part of a frame. picture: receives the pixels. other: the other frame buffer,
  // whose rows may be copied, or null. sought: with RenderMode::kNone, the pairs whose collisions are
  // computed.
  void aim(FrameBuffer& picture, const FrameBuffer* other, RenderMode mode, Collisions sought);

  // Rebuilds everything that is derived from the registers, after a reset or a restored state.
  void rebuild();

  // Draws up to `clock` with the current registers. Does nothing if the beam has passed it.
  RACEBEAM_INLINE void draw_to(std::int32_t clock) {
    if (clock > tia_.cursor && !pass_blank(clock)) draw_beyond(clock);
  }

  // Draws before a change of `part` only: nothing if the beam has not passed a pixel of it.
  RACEBEAM_INLINE void draw_before(std::int32_t clock, const PlayfieldPart& part) {
    if (clock > tia_.cursor && !pass_blank(clock) && !passes_no_pixel_of(clock, part)) draw_beyond(clock);
  }

  // The same on the cursor's line, after enter_line().
  RACEBEAM_INLINE void draw_on_line(std::int32_t clock) {
    if (clock > tia_.cursor) draw_in_line<true>(clock);
  }
  RACEBEAM_INLINE void draw_before_on_line(std::int32_t clock, const PlayfieldPart& part) {
    if (clock > tia_.cursor && !misses(clock, part)) draw_in_line<true>(clock);
  }

  // Computes the collisions up to `clock`, so that the latches can be read or cleared. The pixels are left
  // until a register changes, or the line ends.
  void collide_to(std::int32_t clock);

  // Moves the cursor to `clock` without drawing. The ends of lines are still processed.
  void pass_to(std::int32_t clock);

  // Whether two objects of a sought pair that have not met yet may meet, with the current registers.
  // Meaningless where pixels are drawn.
  bool may_meet() const { return !tia_.vblank && can_meet(tia_.enabled, meetings_); }

  std::uint8_t sought_objects() const { return sought_objects_; }  // objects of the sought pairs

  // objects: those whose registers have changed (bit n: Object n).
  void changed(std::uint8_t objects) { stale_ |= objects; }

  // Called before the registers change without calls of changed(): the masks are compared with them later.
  void suspend_tracking() {
    if (!tracking_is_suspended_) line_.shown = tia_.registers();
    tracking_is_suspended_ = true;
  }

  // For lines that are drawn as a whole:
  bool at_line_start() const { return tia_.left == kLineClocks && tia_.cursor >= start(); }
  std::int32_t line_end() const { return tia_.cursor + tia_.left; }
  bool line_can_end() const { return line_end() < end(); }  // the window's last line never does
  // Draws what the reference writes beyond the last span, which began at `begin` or before. Returns false if
  // that cannot be known.
  bool end_picture(std::int32_t begin);
  // The cursor leaves the blank. The line must be finished before anything else is drawn.
  void enter_line(bool is_recorded) {
    const std::int32_t blank = std::max(tia_.left - kLinePixels, 0);
    tia_.cursor += blank;
    tia_.left -= blank;
    if (!is_recorded && tia_.pixel >= forgotten_) forget_row();
  }
  void finish_line();          // draws the rest of the line and processes its end
  void pass_lines(int count);  // skips lines that are drawn already, and whose ends have been processed
  int lines_to_end() const { return (end() - 1 - tia_.cursor) / kLineClocks; }  // without the last
  std::size_t row() const { return static_cast<std::size_t>(tia_.pixel) / kLinePixels; }
  bool has_record() const { return row() < lines_.rows(); }
  int rows_to_end_of_records() const { return static_cast<int>(lines_.rows() - row()); }
  LineRecord& record() { return lines_.row(row()); }
  LineRecord& open_record() { return lines_.open(row(), tia_.registers()); }
  void forget_lines() { lines_.drop(); }
  std::size_t footprint_of_lines() const { return lines_.footprint(); }

  // The lines that the cursor's row and those after it show.
  const LineNumber* row_lines() const { return &picture_->shows(row()); }
  [[gnu::noinline]] bool can_copy(const LineNumber* lines, LineNumber line) {
    return picture_->copy_row(other_, static_cast<std::size_t>(lines - &picture_->shows(0)), line);
  }

  // Records that the row before the cursor's shows this line.
  void show(LineRecord& line) { picture_->shows(row() - 1) = lines_.add(line); }

  RACEBEAM_INLINE void end_line() {
    const std::uint8_t reflect = tia_.ctrlpf & 1;
    const auto& [p0, p1] = tia_.player;
    if (((tia_.reflect ^ reflect) | p0.skip | p1.skip | tia_.cosmic) != 0) act_on_line_end();
  }

  // What the beam has drawn since reset_observations(): LineDependencies::seen, the pairs that met after the
  // last CXCLR, and the pairs that met before it.
  void reset_observations() { seen_ = meetings_ = cleared_meetings_ = 0; }
  std::uint16_t seen() const { return seen_; }
  Collisions meetings() const { return meetings_; }
  Collisions cleared_meetings() const { return cleared_meetings_; }
  void clear_collisions() {
    tia_.collisions = 0;
    cleared_meetings_ |= meetings_;
    meetings_ = unsought_;
    cleared_ = true;
  }
  bool cleared() const { return cleared_; }  // the collisions, since the step began

  bool exact_spans() const { return mode_ == RenderMode::kExact; }
  bool draws_pixels() const { return mode_ != RenderMode::kNone; }

  std::int32_t start() const { return start_; }  // of the window, in colour clocks
  std::int32_t end() const { return end_; }

 private:
  // Most writes are in the blank of a line, where nothing is drawn.
  RACEBEAM_INLINE bool pass_blank(std::int32_t clock) {
    const std::int32_t clocks = clock - tia_.cursor;
    if (clocks > tia_.left - kLinePixels || tia_.cursor < start_ || tia_.cursor >= end_ || exact_spans())
      return false;
    tia_.cursor = clock;
    tia_.left -= clocks;
    return true;
  }

  bool passes_no_pixel_of(std::int32_t clock, const PlayfieldPart& part) {
    return !exact_spans() && tia_.cursor >= start_ && clock <= line_end() && clock <= end_ &&
           misses(clock, part);
  }

  // Whether no pixel of the part lies between the cursor and `clock`, which is on its line.
  bool misses(std::int32_t clock, const PlayfieldPart& part) {
    const int first = kLinePixels - tia_.left, last = first + clock - tia_.cursor;
    const bool left = first < part.left_end && last > part.left,
               right = first < part.right_end && last > part.right;
    if (left || right) return false;
    // If it was enabled, its position matters.
    if (tia_.enabled & object_bit(kPlayfield)) seen_ |= object_bit(kPlayfield);
    return true;
  }

  // Whether the last HMOVE was before this clock.
  bool is_since_hmove(std::int32_t clock) const {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(clock) - tia_.hmove_clock) > 0;
  }

  bool comb_may_pass(int last) const;
  void draw_beyond(std::int32_t clock);
  template <bool kMayPass>
  void draw_in_line(std::int32_t clock);
  void forget_row();
  std::size_t rows_needed() const;
  void find_window();
  void draw_span(int begin, int clocks);
  std::uint8_t* row_of(int first);
  void draw_visible(std::uint8_t* row, int first, int last, int drawn_to);
  void collide(int first, int last);
  void spill(std::uint8_t* row, int first, int last);
  void blank_comb(std::uint8_t* row, int begin, int end, int first, int last);
  void blank_comb(std::uint8_t* row, int first, int last);
  void act_on_line_end();
  void advance_cosmic();

  TiaState& tia_;
  const Video& video_;
  const DrawPixels draw_pixels_;
  FrameBuffer* picture_ = nullptr;
  const FrameBuffer* other_ = nullptr;
  LineCache lines_;
  std::int32_t start_ = 0, end_ = 0;
  alignas(64) Line line_;
  std::uint8_t stale_ = 0xFF;  // masks to rebuild, bit n: Object n
  bool tracking_is_suspended_ = false;
  std::uint16_t seen_ = 0;
  Collisions meetings_ = 0;  // pairs that have met: they need not be computed
  Collisions cleared_meetings_ = 0;
  Collisions unsought_ = 0;  // pairs that are not sought
  std::uint8_t sought_objects_ = 0;
  bool cleared_ = false;
  std::int32_t collided_ = 0;   // collisions are known up to this clock, or to the cursor if that is later
  std::int32_t forgotten_ = 0;  // up to this pixel, forget_row() has been called
  RenderMode mode_ = RenderMode::kDrawn;
};

}  // namespace racebeam
