#include "emulator/tia/tia.hpp"

#include <algorithm>
#include <limits>

#include "emulator/policies/tuning.hpp"
#include "emulator/tia/line/objects.hpp"
#include "emulator/tia/line_cache/line_dependencies.hpp"
#include "emulator/tia/register_effects.hpp"
#include "emulator/tia/render_policies.hpp"

namespace racebeam {
namespace {

constexpr std::uint32_t kLineOfWrites = TiaWrite(kLineCycles, 0, 0).packed();

constexpr std::array<std::uint32_t, 8> kLanesThatCount = {~0U, ~0U, ~0U, ~0U, 0, 0, 0, 0};

// Whether the writes from `entry` on are those of the record. origin: the line's first cycle, in the form of
// a write of the log.
RACEBEAM_INLINE bool has_same_writes(const std::uint32_t* entry, std::uint32_t origin,
                                     const LineRecord& record) {
  FourWords difference{};
  int remaining = record.count;
  for (const std::uint32_t* event = record.event.data(); remaining > 0;
       event += 4, entry += 4, remaining -= 4) {
    const auto counted =
        load<FourWords>(&kLanesThatCount[static_cast<unsigned>(remaining < 4 ? 4 - remaining : 0)]);
    difference |= ((load<FourWords>(entry) - origin) ^ load<FourWords>(event)) & counted;
  }
  return is_zero(load<TwoWords>(&difference));
}

// How alike two lines are. kStartsAlike: only their beginnings are known to be equal. kLooksAlike: their
// pixels are equal, but the registers may end differently.
enum class Likeness { kOther, kStartsAlike, kLooksAlike, kSame };

// Whether the end of the line may have a further effect: the Cosmic Ark mode moves missile 0.
bool may_be_cosmic(const RegisterVectors& registers, const LineRecord& record) {
  return (record.view.seen & kMayBeCosmic) != 0 || std::bit_cast<TiaRegisters>(registers.part).cosmic != 0;
}

// Compares a line that starts with `registers` and has the writes from `entry` on with a recorded one.
RACEBEAM_INLINE Likeness compare(const RegisterVectors& registers, const std::uint32_t* entry,
                                 std::uint32_t origin, const LineRecord& record) {
  const bool same = record.starts_with(registers);
  if (!same && !record.looks_like(registers)) return Likeness::kOther;
  const LineWrite next(entry[record.count], origin);
  if (next.is_of_line() && !(next.is_late() && (same || !may_be_cosmic(registers, record))))
    return Likeness::kStartsAlike;
  if (!has_same_writes(entry, origin, record)) return Likeness::kStartsAlike;
  return same ? Likeness::kSame : Likeness::kLooksAlike;
}

// Returns how many rows after `record`, whose line has just been recalled, show that line again. write: the
// next write of the log, with its cycle counted from that line's first one.
RACEBEAM_INLINE int repeated_rows(LineRecord* record, const LineRecord* last, const LineNumber* lines,
                                  std::uint32_t write) {
  int rows = 0;
  LineRecord* next = record + 1;
  for (; next != last && next->repeats && *++lines == next->number; ++next, ++rows)
    if (LineWrite(write -= kLineOfWrites).is_of_line()) return rows;
  if (next != last && !next->repeats) next->repeats = next->is_repetition_of(next[-1]);
  return rows;
}

// Whether the writes from `entry` to `end` are those of the record up to the cycle of the word at `end`.
bool has_same_writes_so_far(const std::uint32_t* entry, const std::uint32_t* end, std::uint32_t origin,
                            const LineRecord& record) {
  const auto count = static_cast<std::size_t>(end - entry);
  if (count > record.count) return false;
  const bool is_complete =
      count == record.count || LineWrite(record.event[count]).cycle() >= LineWrite(*end, origin).cycle();
  return is_complete && std::equal(entry, end, record.event.begin(),
                                   [=](std::uint32_t a, std::uint32_t b) { return a - origin == b; });
}

bool has_clear(const std::uint32_t* entry, const std::uint32_t* end) {
  return std::any_of(entry, end, [](std::uint32_t write) { return TiaWrite(write).reg() == CXCLR; });
}

}  // namespace

void Tia::begin_frame() {
  beam_.begin_frame();
  if (!video_.pal) return;
  const int loss = frame_.lines & 1;
  for (std::uint8_t& color : tia_.color) color = static_cast<std::uint8_t>((color & 0xFE) | loss);
}

void Tia::begin_step(FrameBuffer& picture, const FrameBuffer* other, WriteLog& log, RenderMode mode,
                     Collisions sought) {
  beam_.aim(picture, other, mode, sought);
  latches_read_ = 0;
  watches_ = beam_.may_meet() || tia_.cosmic;
  log_ = &log;
  played_ = log.next;
  pending_ = {};
  recorded_ = nullptr;
  reached_ = std::numeric_limits<std::int32_t>::min();
}

void Tia::rebuild() {
  beam_.rebuild();
  recorded_ = nullptr;
  reached_ = std::numeric_limits<std::int32_t>::min();
}

// All writes before `cycle` are in the log, and the sentinel after the last one holds that cycle. On the line
// of `cycle`, only the writes that affect `latches` must be played. Returns false if the rest of that line
// was not played.
bool Tia::play_log(std::int32_t cycle, Collisions latches) {
  const bool empty = log_->size() == 0;
  if (empty && cycle < log_->base) return true;
  const std::int32_t last = empty ? 0 : TiaWrite(log_->next[-1]).cycle();
  *log_->next = TiaWrite(std::max(cycle - log_->base, last), kNone, 0).packed();
  if (!beam_.draws_pixels()) return follow_log();
  for (;;) {
    skip(end_of_unseen());
    if (at_line() && take_lines(latches)) return false;
    if (played_ == log_->next) return true;
    play(played_ + 1);
  }
}

// Whether the latches are the same after the writes that have not been played: none of them clears one that
// is set, and in each other pair, one object is not enabled, nor will be. Many writes are played instead.
bool Tia::is_settled(Collisions latches) {
  if (pending_.first != played_) pending_ = {played_, played_};
  if (log_->next - pending_.last > tuning::kMaxExamined) return false;
  for (; pending_.last != log_->next; ++pending_.last) {
    const TiaWrite write(*pending_.last);
    pending_.control |= kLineEffects[write.reg()].control & kAllObjects;
    pending_.clears |= write.reg() == CXCLR;
    if (write.reg() - GRP0 < 2U && write.value() != 0)
      pending_.filled |= object_bit(kP0 + write.reg() - GRP0);
  }
  if (pending_.clears && (tia_.collisions & latches) != 0) return false;
  unsigned objects = tia_.enabled | pending_.control;
  const auto meet = [&] {
    const auto others = static_cast<Collisions>(tia_.collisions | ~latches);
    return can_meet(static_cast<std::uint8_t>(objects), others);
  };
  if (!meet()) return true;
  for (unsigned i = 0; i < 2; ++i)  // VDELPx and the other player's GRPx cannot enable an empty player
    if ((tia_.player[i].grp | tia_.player[i].old_grp) == 0) objects &= pending_.filled | ~(1U << (kP0 + i));
  return !meet();
}

// Plays the log in steps without pixels.
bool Tia::follow_log() {
  skip(end_of_unseen());
  const TrackPolicy policy{beam_, tia_, reached_, watches_};
  policy.enabled_changed();
  RegisterEffects(tia_, frame_, video_, policy).play(played_, log_->next, log_->base);
  played_ = log_->next;
  return true;
}

void Tia::empty_log(std::int32_t cycle) {
  play_log(cycle);
  log_->rewind(cycle);
  played_ = log_->next;
  pending_ = {};
}

void Tia::catch_up(std::int32_t cycle) {
  play_log(cycle);
  touch(cycle);
  if (!beam_.draws_pixels()) tia_.enabled = enabled_objects(tia_);
}

void Tia::find_collisions(std::int32_t cycle, Collisions latches) {
  latches_read_ |= latches;
  if (beam_.draws_pixels() && !beam_.exact_spans() && is_settled(latches)) return;
  if (!play_log(cycle, latches)) return;
  if (!beam_.draws_pixels()) return touch(cycle);
  RenderPolicy{beam_, reached_}.collide_to(3 * cycle);
}

void Tia::touch(std::int32_t cycle) {
  if (beam_.draws_pixels())
    RenderPolicy{beam_, reached_}.advance_to(3 * cycle);
  else
    TrackPolicy{beam_, tia_, reached_, watches_}.advance_to(3 * cycle);
}

bool Tia::end_picture(std::int32_t cycle) {
  play_log(cycle);
  const std::int32_t reached = reached_;
  touch(cycle);
  if (!beam_.draws_pixels()) tia_.enabled = enabled_objects(tia_);
  return !stopped_inside(cycle) || (reached < 3 * cycle && beam_.end_picture(reached));
}

bool Tia::stopped_inside(std::int32_t cycle) const {
  return tia_.cursor < beam_.end() && 3 * cycle + kLongestDelay > beam_.start();
}

// Plays write by write, up to `next`.
void Tia::play(const std::uint32_t* next) {
  RegisterEffects(tia_, frame_, video_, RenderPolicy{beam_, reached_}).play(played_, next, log_->base);
  played_ = next;
  if (beam_.exact_spans()) beam_.draw_to(reached_);
}

// Plays the remaining writes of the cursor's line, and draws the line to its end.
void Tia::play_rest(const std::uint32_t* next) {
  beam_.enter_line(recorded_ != nullptr);
  RegisterEffects(tia_, frame_, video_, LinePolicy{{beam_, reached_}}).play(played_, next, log_->base);
  played_ = next;
  beam_.finish_line();
}

// Plays writes that need no drawing.
void Tia::skip(const std::uint32_t* next) {
  if (next == played_) return;
  replay(next);
  played_ = next;
}

// Changes the registers as the writes up to `next` do.
[[gnu::noinline]] void Tia::replay(const std::uint32_t* next) {
  RegisterEffects(tia_, frame_, video_, ReplayPolicy{beam_}).play(played_, next, log_->base);
  tia_.enabled = enabled_objects(tia_);
}

// Returns the end of the writes that cannot be seen: those before the window, or all once the window is full.
const std::uint32_t* Tia::end_of_unseen() const {
  if (tia_.cursor >= beam_.end()) return log_->next;
  const std::uint32_t* at = played_;
  if (tia_.cursor != beam_.start() || !beam_.at_line_start()) return at;
  while (at != log_->next && 3 * (log_->base + TiaWrite(*at).cycle()) + kLongestDelay <= beam_.start()) ++at;
  return at;
}

std::uint32_t Tia::line_origin() const {
  return TiaWrite(beam_.line_end() / 3 - kLineCycles - log_->base, 0, 0).packed();
}

// Whether the cursor's line can be taken as a whole: the next write is on this line or after it, and the beam
// is not beyond the place where the line is taken up.
bool Tia::at_line() const {
  if (beam_.exact_spans() || tia_.cursor < beam_.start() || !beam_.line_can_end()) return false;
  const std::int32_t first_cycle = beam_.line_end() / 3 - kLineCycles - log_->base;
  if (first_cycle < 0 || TiaWrite(*played_).cycle() + kEarliestWrite < first_cycle) return false;
  const bool begins = beam_.at_line_start() && recorded_ == nullptr;
  return reached_ <= (begins ? tia_.cursor : beam_.line_end());
}

// Takes line after line as a whole: recalled if it exists, else drawn and recorded. Returns true if nothing
// more need be played.
bool Tia::take_lines(Collisions latches) {
  std::uint32_t origin = line_origin();
  while (beam_.line_can_end()) {
    if (beam_.at_line_start() && recorded_ == nullptr) {
      if (reached_ > tia_.cursor) return false;
      if (may_recur(origin) && recall_lines(origin, latches)) return true;
      if (!beam_.line_can_end()) return false;
    }
    if (!draw_line(origin)) return false;
    origin += kLineOfWrites;
  }
  return false;
}

// Whether the record of the cursor's row may be of a line that begins like this one. A quick check, which
// most lines that do not recur fail.
RACEBEAM_INLINE bool Tia::may_recur(std::uint32_t origin) {
  if (!beam_.has_record()) return false;
  const LineRecord& record = beam_.record();
  if (record.count != 0 && played_ != log_->next && *played_ - origin != record.event[0]) return false;
  return record.is_summarized() || record.looks_like(RegisterVectors(tia_));
}

// Whether the `latches` have the same values at the end of the writes as at the beginning of their
// line. The record's line begins with the same registers.
bool Tia::keeps_latches(const LineRecord& record, std::uint32_t origin, Collisions latches) const {
  const Collisions met = record.meetings | record.cleared;
  if (record.is_open() || (met & latches & ~tia_.collisions) != 0) return false;
  if ((record.view.seen & kClears) != 0 && has_clear(played_, log_->next)) return false;
  return has_same_writes_so_far(played_, log_->next, origin, record);
}

// Recalls lines that start with the same relevant registers and have the same writes as when these rows were
// last drawn. Stops at a line of which only the first writes are known. Returns true if these are equal so
// far, and do not change `latches`.
bool Tia::recall_lines(std::uint32_t& origin, Collisions latches) {
  RegisterVectors registers(tia_);
  std::int32_t cursor = tia_.cursor;
  const LineNumber* lines = beam_.row_lines();
  LineRecord* const first = &beam_.record();
  LineRecord* const last = first + std::min(beam_.lines_to_end(), beam_.rows_to_end_of_records());
  LineRecord* record = first;
  bool enough = false;
  for (; record != last; ++record, ++lines, origin += kLineOfWrites, cursor += kLineClocks) {
    const Likeness likeness = compare(registers, played_, origin, *record);
    if (likeness < Likeness::kLooksAlike ||
        (*lines != record->number && !beam_.can_copy(lines, record->number))) {
      enough = likeness == Likeness::kStartsAlike && latches != kWholePicture &&
               keeps_latches(*record, origin, latches);
      break;
    }
    const std::uint32_t* next = played_ + record->count;
    if (likeness == Likeness::kSame) {
      record->pass(registers);
      if (record->view.seen & kMoves)
        tia_.hmove_clock = static_cast<std::uint32_t>(cursor + record->hmove_clock);
      if (record->view.seen & kClears) beam_.clear_collisions();
    } else {
      beam_.suspend_tracking();
      registers.write(tia_);
      play_recalled(next, *record);
      registers.read(tia_);
    }
    played_ = next;
    tia_.collisions |= record->meetings;
    if (likeness != Likeness::kSame || record->count != 0) continue;
    const int repetitions = repeated_rows(record, last, lines, *played_ - origin);
    record += repetitions, lines += repetitions, cursor += repetitions * kLineClocks;
    origin += static_cast<std::uint32_t>(repetitions) * kLineOfWrites;
  }
  if (record == first) return enough;
  beam_.suspend_tracking();
  registers.write(tia_);
  beam_.pass_lines(static_cast<int>(record - first));
  return enough;
}

// Plays the writes of a line whose pixels exist, because the registers may end differently.
void Tia::play_recalled(const std::uint32_t* next, LineRecord& record) {
  replay(next);
  tia_.comb_armed = record.end.comb_armed;
  beam_.end_line();
  if (!record.is_summarized()) record.summarize(video_.pal);
}

// Draws the cursor's line up to the last write, or to its end if the next write lies after it. Returns true
// in the second case.
bool Tia::draw_line(std::uint32_t origin) {
  if (beam_.at_line_start() && beam_.has_record() && recorded_ == nullptr) {
    recorded_ = &beam_.open_record();
    beam_.reset_observations();
  }
  const std::uint32_t* next = recorded_ != nullptr ? recorded_->add(played_, origin) : played_;
  if (recorded_ == nullptr)
    while (LineWrite(*next, origin).acts_here()) ++next;
  if (!LineWrite(*next, origin).is_of_line())
    play_rest(next);
  else if (play(next); ends_early(next, origin))
    beam_.finish_line();
  else
    return false;
  close_record();
  return true;
}

// Whether only late writes of the line remain. If others remain, which act on two lines or are too many for a
// record, the line is not recorded.
bool Tia::ends_early(const std::uint32_t* next, std::uint32_t origin) {
  // In Cosmic Ark mode, the end of a line has a further effect, and it matters whether that comes before a
  // late write.
  if (LineWrite(*next, origin).is_late() && recorded_ != nullptr && tia_.cosmic == 0) return true;
  if (next != log_->next) recorded_ = nullptr;
  return false;
}

void Tia::close_record() {
  if (recorded_ == nullptr) return;
  recorded_->view.seen |= beam_.seen();
  recorded_->meetings = beam_.meetings();
  recorded_->cleared = beam_.cleared_meetings();
  recorded_->close(tia_, tia_.cursor - kLineClocks);
  beam_.show(*recorded_);
  recorded_ = nullptr;
}

// Shows what is seen if the processor stops in the middle of a picture (docs/spec/tia.md, "Greying").
void Tia::grey(FrameBuffer& picture, std::int32_t cycle) const {
  const int line = (3 * cycle - tia_.origin) / kLineClocks;
  const int first = std::clamp(line - video_.ystart, 0, video_.height);
  const auto window = picture.pixels().first(static_cast<std::size_t>(video_.height) * kLinePixels);
  for (std::uint8_t& pixel : window.subspan(static_cast<std::size_t>(first) * kLinePixels))
    pixel = (pixel & 15) >> 1;
  picture.forget_lines();
}

}  // namespace racebeam
