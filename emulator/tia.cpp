#include "emulator/tia.hpp"

#include <algorithm>
#include <limits>

#include "emulator/line_key.hpp"
#include "emulator/register_effects.hpp"

namespace racebeam {
namespace {

// Draws what stood before a change, as far as the beam had come.
struct Drawing {
  Beam& beam;
  std::int32_t& reached;

  RACEBEAM_INLINE void reach(std::int32_t clock) const { reached = clock > reached ? clock : reached; }
  RACEBEAM_INLINE void draw_to(std::int32_t clock) const {
    reach(clock);
    beam.draw_to(reached);
  }
  RACEBEAM_INLINE void changed(std::uint8_t objects) const { beam.changed(objects); }
};

// The line's pixels are there already; only the registers are wanted.
struct Recalling {
  Beam& beam;

  RACEBEAM_INLINE void reach(std::int32_t) const {}
  RACEBEAM_INLINE void draw_to(std::int32_t) const {}
  RACEBEAM_INLINE void changed(std::uint8_t objects) const { beam.changed(objects); }
};

// Writes from here on, counted from a line's first cycle, are beyond it. One in cycle 76 can still act on the line: it is
// at the clock at which the next one begins.
constexpr std::uint32_t kBeyondLine = TiaWrite(kLineCycles + 1, 0, 0).packed();
constexpr std::uint32_t kLineOfWrites = TiaWrite(kLineCycles, 0, 0).packed();

// A write that comes this much later than RESPx, or sooner, may wait for the old copy of the player.
constexpr std::uint32_t kWaitOfRespx = TiaWrite(4, 0, 0).packed() - 1;

// Are the next writes those of the record, and is the one after them beyond the line? `origin` is the line's first
// cycle as a write has it.
bool meets_the_same(const std::uint32_t* entry, std::uint32_t origin, const LineRecord& record) {
  const unsigned count = record.count;
  if (count == LineRecord::kInvalid || entry[count] - origin < kBeyondLine) return false;
  for (unsigned i = 0; i < count; ++i)
    if (entry[i] - origin != record.event[i]) return false;
  return true;
}

constexpr std::int32_t kLongestDelay = 11;  // colour clocks that a write may draw ahead

}  // namespace

void Tia::begin_frame() {
  beam_.begin_frame();
  if (!video_.pal) return;
  const int loss = frame_.lines & 1;
  for (std::uint8_t& color : tia_.color) color = static_cast<std::uint8_t>((color & 0xFE) | loss);
}

void Tia::begin_step(Picture& picture, WriteLog& log, bool exact) {
  beam_.aim(picture);
  beam_.set_exact_spans(exact);
  log_ = &log;
  played_ = log.next;
  reached_ = std::numeric_limits<std::int32_t>::min();
}

// The word behind the last write says up to which cycle there is no other.
void Tia::play_log(std::int32_t cycle) {
  const bool empty = log_->size() == 0;
  if (empty && cycle < log_->base) return;
  const std::int32_t last = empty ? 0 : TiaWrite(log_->next[-1]).cycle();
  *log_->next = TiaWrite(std::max(cycle - log_->base, last), WriteLog::kNobody, 0).packed();
  for (;;) {
    skip(end_of_unseen());
    if (finish_line() || at_whole_line()) take_lines();
    if (played_ == log_->next) return;
    play(played_ + 1);
  }
}

void Tia::empty_log(std::int32_t cycle) {
  play_log(cycle);
  log_->rewind(cycle);
  played_ = log_->next;
}

void Tia::touch(std::int32_t cycle) { Drawing{beam_, reached_}.draw_to(3 * cycle); }

bool Tia::stopped_inside(std::int32_t cycle) const {
  return tia_.cursor < beam_.end() && 3 * cycle + kLongestDelay > beam_.start();
}

// Write by write, or up to `next`.
void Tia::play(const std::uint32_t* next) {
  RegisterEffects(tia_, frame_, video_, Drawing{beam_, reached_}).play(played_, next, log_->base);
  played_ = next;
  if (beam_.exact_spans()) beam_.draw_to(reached_);
}

// Up to `next`, for what needs no drawing.
void Tia::skip(const std::uint32_t* next) {
  RegisterEffects(tia_, frame_, video_, Recalling{beam_}).play(played_, next, log_->base);
  played_ = next;
}

// Nothing can be seen of what is written before the window, or when it is full.
const std::uint32_t* Tia::end_of_unseen() const {
  if (tia_.cursor >= beam_.end()) return log_->next;
  const std::uint32_t* at = played_;
  if (tia_.cursor != beam_.start() || !beam_.at_line_start()) return at;
  while (at != log_->next && 3 * (log_->base + TiaWrite(*at).cycle()) + kLongestDelay <= beam_.start()) ++at;
  return at;
}

// Draws the rest of a line that has begun, if the next write lies beyond it.
bool Tia::finish_line() {
  if (beam_.exact_spans() || tia_.left == kLineClocks || !beam_.line_can_end()) return false;
  if (3 * (log_->base + TiaWrite(*played_).cycle()) <= beam_.line_end()) return false;
  beam_.finish_line();
  return at_whole_line();
}

bool Tia::at_whole_line() const {
  if (beam_.exact_spans() || !beam_.at_line_start() || reached_ > tia_.cursor) return false;
  const std::int32_t first_cycle = tia_.cursor / 3 - log_->base;
  return first_cycle >= 0 && TiaWrite(*played_).cycle() >= first_cycle;
}

// Takes as many lines as can be taken as a whole.
void Tia::take_lines() {
  std::uint32_t origin = TiaWrite(tia_.cursor / 3 - log_->base, 0, 0).packed();
  while (beam_.line_can_end() && beam_.has_record() && take_line(origin)) origin += kLineOfWrites;
}

// A line that starts with the same registers, as far as they count, and meets the same writes as when this row of the
// buffer was drawn last is there already; another one is drawn, and remembered. False if a write, or what is not
// written yet, may act on two lines.
bool Tia::take_line(std::uint32_t origin) {
  LineRecord& record = beam_.record();
  if (meets_the_same(played_, origin, record)) {
    if (look_the_same(tia_, record.start, record.view)) recall_line(record);
    else draw_line(record, record.count);
    return true;
  }
  std::uint8_t count = 0;
  if (!gather_events(origin, record, count)) return false;
  draw_line(record, count);
  return true;
}

void Tia::recall_line(const LineRecord& record) {
  skip(played_ + record.count);
  beam_.take_line(record);
}

// Draws the cursor's line, whose writes the row's record has, and remembers it.
void Tia::draw_line(LineRecord& record, std::uint8_t count) {
  record.start = tia_.registers();
  const Collisions before = tia_.collisions;
  tia_.collisions = 0;  // the record keeps those of this line
  beam_.look_afresh();
  play(played_ + count);
  beam_.finish_line();
  record.view.seen = static_cast<std::uint16_t>((record.view.seen & kMoves) | beam_.seen());
  record.meetings = tia_.collisions;
  record.comb_armed = tia_.comb_armed;
  record.count = count;
  if (!record.view.clears) tia_.collisions |= before;
}

// The writes that the cursor's line meets; false if it can't be taken as a whole.
bool Tia::gather_events(std::uint32_t origin, LineRecord& record, std::uint8_t& count) const {
  record.count = LineRecord::kInvalid;
  record.view = {};
  for (const std::uint32_t* at = played_;; ++at) {
    const std::uint32_t since = *at - origin;
    if (since >= kBeyondLine) return true;
    const TiaWrite write(since);
    const LineEffect effect = kLineEffects[write.reg()];
    if (at == log_->next || count == record.event.size() || write.cycle() > effect.last_cycle) return false;
    record.event[count++] = since;
    record.view.seen |= effect.seen;
    record.view.clears |= write.reg() == CXCLR;
    const bool waits = write.reg() == RESP0 || write.reg() == RESP1;
    if (!waits || at[1] - *at <= kWaitOfRespx) record.view.control |= effect.control;
  }
}

// tia.md, section 2, "Greying": what is seen when the processor stands still in the middle of a picture.
void Tia::grey(Picture& picture, std::int32_t cycle) const {
  const int line = (3 * cycle - tia_.origin) / kLineClocks;
  const int first = std::max(line, video_.ystart) - video_.ystart;
  for (int i = first * kLinePixels; i < video_.height * kLinePixels; ++i)
    picture.pixel[static_cast<std::size_t>(i)] = (picture.pixel[static_cast<std::size_t>(i)] & 15) >> 1;
  picture.forget_lines();
}

}  // namespace racebeam
