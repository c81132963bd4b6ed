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

// Does the same write on the same line always do the same? CXCLR acts on lines before, and what may be the start of
// Cosmic Ark mode depends on when the last HMOVE was.
bool is_repeatable(TiaWrite write) {
  return write.reg() != CXCLR && !(write.reg() == HMM0 && write.value() >> 4 == 6);
}

constexpr const std::uint32_t* kNowhere = nullptr;
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
  beam_.changed(0);
  beam_.set_exact_spans(exact);
  log_ = &log;
  played_ = log.next;
  reached_ = std::numeric_limits<std::int32_t>::min();
}

void Tia::play_log() {
  while (played_ != log_->next)
    if (!play_line()) play(played_ + 1);
}

void Tia::empty_log(std::int32_t cycle) {
  play_log();
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

// Plays a whole line at once, if the beam is at its start and the next write is known to lie beyond its end. A line
// that starts with the same visible registers and meets the same writes as when this row of the buffer was drawn last
// is there already.
bool Tia::play_line() {
  const std::int32_t clock = 3 * (log_->base + TiaWrite(*played_).cycle());
  if (clock <= beam_.start() || !beam_.line_can_end() || beam_.exact_spans()) return false;
  if (!beam_.at_line_start()) {
    if (clock <= beam_.line_end()) return false;
    beam_.finish_line();
    return true;
  }
  if (reached_ > tia_.cursor) return false;
  const LineRecord& known = beam_.record();
  const std::uint32_t* next = end_of_known_line(known);
  if (next == kNowhere) return draw_new_line();
  if (has_key(tia_, known.involved, known.key)) recall_line(next);
  else draw_line(next, known.count);
  return true;
}

// The first write beyond the cursor's line, if the line meets the writes of `known`.
const std::uint32_t* Tia::end_of_known_line(const LineRecord& known) const {
  if (known.count == LineRecord::kInvalid) return kNowhere;
  const std::int32_t first_cycle = beam_.line_end() / 3 - kLineCycles - log_->base;
  const std::uint32_t origin = TiaWrite(first_cycle, 0, 0).packed();
  unsigned count = 0;
  for (const std::uint32_t* at = played_; at != log_->next; ++at) {
    if (TiaWrite(*at).cycle() > first_cycle + kLineCycles) return count == known.count ? at : kNowhere;
    if (count == known.count || known.event[count++] != *at - origin) break;
  }
  return kNowhere;
}

void Tia::recall_line(const std::uint32_t* next) {
  RegisterEffects(tia_, frame_, video_, Recalling{beam_}).play(played_, next, log_->base);
  played_ = next;
  beam_.take_line(beam_.record());
}

// Draws the cursor's line, whose writes the row's record has, and remembers it.
void Tia::draw_line(const std::uint32_t* next, std::uint8_t count) {
  LineRecord& record = beam_.record();
  record.key = line_key(tia_, record.involved);
  const std::uint16_t collisions = tia_.collisions;
  tia_.collisions = 0;  // the record keeps those of this line
  play(next);
  beam_.finish_line();
  record.meetings = tia_.collisions;
  record.repeats = beam_.repeats();
  record.comb_armed = tia_.comb_armed;
  record.count = count;
  tia_.collisions |= collisions;
}

// The same for other writes than the record's; false if the line can't be taken as a whole.
bool Tia::draw_new_line() {
  LineRecord& record = beam_.record();
  record.count = LineRecord::kInvalid;
  std::uint8_t count = 0;
  const std::uint32_t* next = gather_events(record, count);
  if (next == kNowhere) return false;
  draw_line(next, count);
  return true;
}

// The writes that the cursor's line meets. Returns the first one beyond it.
const std::uint32_t* Tia::gather_events(LineRecord& line, std::uint8_t& count) const {
  const std::int32_t first_cycle = beam_.line_end() / 3 - kLineCycles - log_->base;
  const std::uint32_t origin = TiaWrite(first_cycle, 0, 0).packed();
  line.involved = 0;
  for (const std::uint32_t* at = played_; at != log_->next; ++at) {
    const TiaWrite write(*at);
    const std::int32_t cycle = write.cycle() - first_cycle;
    if (cycle > kLineCycles) return at;
    const LineEffect effect = kLineEffects[write.reg()];
    if (count == line.event.size() || cycle > effect.last_cycle || !is_repeatable(write)) break;
    line.involved |= effect.involved;
    line.event[count++] = *at - origin;
  }
  return kNowhere;
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
