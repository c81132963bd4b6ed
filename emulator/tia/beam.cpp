#include "emulator/tia/beam.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

namespace racebeam {
namespace {

// Pixels that are written at once. The number is not one to tune: it is that of the bytes of an AVX2 register
// (line/pixels_x86.cpp), and divides a row.
constexpr int kGroup = 32;
static_assert(kLinePixels % kGroup == 0);

constexpr int kCombEnd = kBlankClocks + 8;  // an HMOVE blanks up to this clock of the line

// The sets of enabled objects (bit n: Object n) for which the reference writes pixels in groups of four.
bool writes_groups(unsigned enabled, std::uint8_t ctrlpf) {
  constexpr unsigned p0 = 1U << kP0, p1 = 1U << kP1, m0 = 1U << kM0, m1 = 1U << kM1, bl = 1U << kBall,
                     pf = 1U << kPlayfield;
  switch (enabled) {
    case pf:
    case p0:
    case p1:
    case p0 | p1:
    case m0:
    case m1:
    case bl:
    case m0 | m1:
    case bl | m0:
    case bl | m1:
    case bl | p1: return true;
    case pf | p0:
    case pf | p1:
    case pf | bl: return (ctrlpf & 2) == 0;
    default: return false;
  }
}

// The positions of the enabled objects except the playfield; those of players whatever their graphics.
PixelMask shapes(const TiaState& tia, const Line& line) {
  PixelMask all = line.mask[kM0] | line.mask[kM1] | line.mask[kBall];
  for (unsigned i = 0; i < 2; ++i)
    if (tia.enabled >> (kP0 + i) & 1) all = all | player_shape(tia.player[i]);
  return all;
}

}  // namespace

Beam::Beam(TiaState& state, const Video& video)
    : tia_(state), video_(video), draw_pixels_(pixel_drawer(simd())) {}

void Beam::find_window() {
  start_ = tia_.origin + kLineClocks * video_.ystart;
  end_ = start_ + kLineClocks * video_.height;
}

void Beam::begin_frame() {
  find_window();
  lines_.begin_frame();
  tia_.cursor = start();
  tia_.left = kLineClocks;
  tia_.pixel = 0;
}

void Beam::aim(FrameBuffer& picture, const FrameBuffer* other, RenderMode mode, Collisions sought) {
  picture_ = &picture;
  other_ = other;
  mode_ = mode;
  if (draws_pixels()) {
    picture.make_room(rows_needed());
    lines_.aim(static_cast<std::size_t>(video_.height));
  }
  forgotten_ = draws_pixels() ? 0 : std::numeric_limits<std::int32_t>::max();
  unsought_ = draws_pixels() ? Collisions{0} : static_cast<Collisions>(~sought);
  sought_objects_ = draws_pixels() ? kAllObjects : objects_of(sought);
  cleared_ = false;
  collided_ = tia_.cursor;
  reset_observations();
  if (!draws_pixels()) meetings_ = unsought_ | tia_.collisions;
}

// Rows up to the window's end.
std::size_t Beam::rows_needed() const {
  const int to_come = std::max(end_ - tia_.cursor, 0) + kLineClocks - 1;
  return row() + static_cast<std::size_t>(to_come / kLineClocks);
}

void Beam::rebuild() {
  find_window();
  reset_observations();
  tia_.enabled = enabled_objects(tia_);
  stale_ = 0xFF;
}

void Beam::draw_beyond(std::int32_t clock) {
  const std::int32_t stop = end();
  const bool in_line = tia_.cursor >= start() && clock <= tia_.cursor + tia_.left && clock <= stop;
  if (in_line && !exact_spans()) return draw_in_line<false>(clock);
  if (clock < start() || tia_.cursor >= stop || tia_.cursor >= clock) return;
  clock = std::min(clock, stop);
  do {
    const int begin = kLineClocks - tia_.left;
    const bool completes = clock > tia_.cursor + tia_.left;
    const int clocks = completes ? tia_.left : clock - tia_.cursor;
    tia_.cursor += clocks;
    tia_.left = completes ? kLineClocks : tia_.left - clocks;
    draw_span(begin, clocks);
    if (completes) end_line();
  } while (tia_.cursor < clock);
}

void Beam::collide_to(std::int32_t clock) {
  if (clock <= tia_.cursor) return;
  if (exact_spans() || tia_.cursor < start() || clock > line_end() || clock > end())
    return draw_beyond(clock);
  const int at_cursor = kLinePixels - tia_.left;
  const int first = std::max(at_cursor + std::max(collided_ - tia_.cursor, 0), 0);
  const int last = at_cursor + clock - tia_.cursor;
  if (last > first && !tia_.vblank) collide(first, last);
  collided_ = clock;
}

// The address of the row of the cursor, which is at pixel `first`. Without pixels the picture may have no
// rows, and the result is not a valid address. It is therefore computed with integers: a branch would cost up
// to 80 % more instructions a frame.
RACEBEAM_INLINE std::uint8_t* Beam::row_of(int first) {
  const auto rows = reinterpret_cast<std::uintptr_t>(picture_->pixels().data());
  const std::uintptr_t row =
      rows + static_cast<std::uintptr_t>(tia_.pixel) - static_cast<std::uintptr_t>(first);
  return reinterpret_cast<std::uint8_t*>(row);  // NOLINT(performance-no-int-to-ptr)
}

// The common case: from the cursor to a visible clock on the same line. kMayPass: the pixels after that are
// drawn later, so that whole groups of them can be written.
template <bool kMayPass>
void Beam::draw_in_line(std::int32_t clock) {
  const int first = std::max(kLinePixels - tia_.left, 0);
  tia_.left -= clock - tia_.cursor;
  tia_.cursor = clock;
  const int last = kLinePixels - tia_.left;
  std::uint8_t* const row = row_of(first);
  if (!kMayPass && tia_.pixel >= forgotten_) forget_row();
  draw_visible(row, first, last, kMayPass ? (last + kGroup - 1) & ~(kGroup - 1) : last);
  if (tia_.comb_armed && first < kCombEnd - kBlankClocks) blank_comb(row, first, last);
  tia_.pixel += last - first;
}
template void Beam::draw_in_line<true>(std::int32_t clock);

void Beam::finish_line() {
  if (tia_.left > 0) draw_in_line<true>(line_end());
  tia_.left = kLineClocks;
  end_line();
}

// Records that the cursor's row no longer shows a known line.
void Beam::forget_row() {
  picture_->shows(row()) = kAnyLine;
  forgotten_ = (static_cast<std::int32_t>(row()) + 1) * kLinePixels;
}

void Beam::pass_to(std::int32_t clock) {
  clock = std::min(clock, end());
  if (clock < start() || tia_.cursor >= clock) return;
  const auto pass = [this](std::int32_t clocks) {
    const int first = kLineClocks - tia_.left, last = first + clocks;
    if (first < kCombEnd && last >= kCombEnd && is_since_hmove(tia_.cursor + kCombEnd - first))
      tia_.comb_armed = 0;
    tia_.pixel += std::max(last, kBlankClocks) - std::max(first, kBlankClocks);
    tia_.cursor += clocks;
    tia_.left -= clocks;
  };
  while (clock > line_end()) {
    pass(tia_.left);
    end_line();
    // At their ends, nothing happens.
    const int others = tia_.cosmic ? 0 : (clock - 1 - tia_.cursor) / kLineClocks;
    pass_lines(others);
    if (others > 0 && is_since_hmove(tia_.cursor - kLineClocks + kCombEnd)) tia_.comb_armed = 0;
    tia_.left = kLineClocks;
  }
  pass(clock - tia_.cursor);
}

void Beam::pass_lines(int count) {
  tia_.cursor += count * kLineClocks;
  tia_.pixel += count * kLinePixels;
}

void Beam::draw_span(int begin, int clocks) {
  const int end_clock = begin + clocks;
  const int visible = std::min(std::max(begin, kBlankClocks), end_clock);
  const int first = std::max(visible - kBlankClocks, 0);
  const int last = std::max(end_clock - kBlankClocks, first);
  std::uint8_t* const row = row_of(first);
  if (tia_.pixel >= forgotten_) forget_row();
  if (last > first) draw_visible(row, first, last, last);
  if (tia_.comb_armed && visible < kCombEnd) blank_comb(row, visible, end_clock, first, last);
  tia_.pixel += last - first;
}

// drawn_to: `last`, or a later pixel up to which the row may be overwritten.
RACEBEAM_INLINE void Beam::draw_visible(std::uint8_t* row, int first, int last, int drawn_to) {
  if (tia_.vblank) {
    if (draws_pixels()) std::memset(row + first, 0, static_cast<std::size_t>(last - first));
    return;
  }
  const bool score = (tia_.enabled & object_bit(kPlayfield)) != 0 && (tia_.ctrlpf & 2) != 0;
  seen_ |= tia_.enabled | kLit | (score ? kScoreSeen : 0);
  const int collided = last - (tia_.cursor - collided_);  // collide_to() has been here
  if (collided < last) collide(std::max(first, collided), last);
  if (draws_pixels()) draw_pixels_(line_, tia_, row, first, drawn_to);
  if (exact_spans()) spill(row, first, last);
}

RACEBEAM_INLINE void Beam::collide(int first, int last) {
  if (!draws_pixels() && !can_meet(tia_.enabled, meetings_)) return;
  if (tracking_is_suspended_) stale_ |= line_.outdated(tia_);
  tracking_is_suspended_ = false;
  if (const std::uint8_t stale = stale_ & sought_objects_; stale != 0) {
    line_.refresh(tia_, stale);
    stale_ ^= stale;
  }
  const auto sought = static_cast<Collisions>(line_.overlaps & ~meetings_);
  if (sought == 0) return;
  const Collisions found = racebeam::meetings(line_, first, last, sought);
  meetings_ |= found;
  tia_.collisions |= found;
}

// The reference writes some pixels in groups of four, and so up to three beyond the span (docs/spec/tia.md,
// "Provisional pixels").
void Beam::spill(std::uint8_t* row, int first, int last) {
  const int group = last & ~3;
  if (group == last || group < first || !writes_groups(tia_.enabled, tia_.ctrlpf)) return;
  if (shapes(tia_, line_).meets(PixelMask::range(group, group + 4))) return;
  std::memset(row + last, row[group], static_cast<std::size_t>(group + 4 - last));
}

// Whether an HMOVE may have blanked pixels from `last` on. A span that ends in a line's blank makes up to 75
// pixels of the line black (docs/spec/tia.md, 5). Those that are never drawn stay black.
bool Beam::comb_may_pass(int last) const {
  if (tia_.comb_armed) return true;
  if (last < kCombEnd - kBlankClocks || last >= kCombEnd - 1) return false;
  const std::int32_t line_start = tia_.cursor - kBlankClocks - last;
  return row() == 0 || !is_since_hmove(line_start - kLineClocks + kCombEnd);
}

bool Beam::end_picture(std::int32_t begin) {
  const int line_clock = kLineClocks - tia_.left, last = line_clock - kBlankClocks;
  if (comb_may_pass(last)) return false;
  const std::int32_t first_visible = tia_.cursor - line_clock + kBlankClocks;
  const int first = std::max(begin, first_visible) - first_visible;
  if (last > first && !tia_.vblank && draws_pixels())
    spill(picture_->pixels().data() + tia_.pixel - last, first, last);
  return true;
}

// Blackens the eight pixels at the start of a line after an HMOVE.
void Beam::blank_comb(std::uint8_t* row, int first, int last) {
  constexpr int kWidth = kCombEnd - kBlankClocks;
  if (draws_pixels()) std::memset(row + first, 0, static_cast<std::size_t>(std::min(kWidth, last) - first));
  if (last >= kWidth) tia_.comb_armed = 0;
}

// Blanks for RenderMode::kExact. The reference blanks from the span's first pixel on, past its end. That is
// visible only if drawing stops there.
void Beam::blank_comb(std::uint8_t* row, int begin, int end, int first, int last) {
  int blank_to = first + kCombEnd - begin;
  if (!exact_spans()) blank_to = std::min(blank_to, last);
  if (blank_to > first && draws_pixels())
    std::memset(row + first, 0, static_cast<std::size_t>(blank_to - first));
  if (end >= kCombEnd) tia_.comb_armed = 0;
}

void Beam::act_on_line_end() {
  const std::uint8_t reflect = tia_.ctrlpf & 1;
  auto& [p0, p1] = tia_.player;
  if (tia_.reflect != reflect) changed(object_bit(kPlayfield));
  if (p0.skip) changed(object_bit(kP0));
  if (p1.skip) changed(object_bit(kP1));
  tia_.reflect = reflect;
  p0.skip = p1.skip = 0;
  if (tia_.cosmic) advance_cosmic();
}

// Missile 0 keeps moving 17 clocks a line, in a pattern of four (docs/spec/tia.md, 9).
void Beam::advance_cosmic() {
  static constexpr std::uint8_t kStep[4] = {18, 33, 0, 17};
  static constexpr CosmicShape kShape[4] = {CosmicShape::kNormal, CosmicShape::kStretched,
                                            CosmicShape::kHidden, CosmicShape::kNormal};
  tia_.cosmic_count = (tia_.cosmic_count + 1) & 3;
  std::uint8_t& position = tia_.missile[0].position;
  position = static_cast<std::uint8_t>((position + kLinePixels - kStep[tia_.cosmic_count]) % kLinePixels);
  tia_.cosmic_shape = kShape[tia_.cosmic_count];
  changed(1U << kM0);
}

}  // namespace racebeam
