// Runs a frame, with or without its pixels (docs/spec/tia.md, 2). A frame whose pixels are not observed
// leaves its writes in the picture. They are played if the picture is read later.
#include "emulator/base/stopwatch.hpp"
#include "emulator/console_impl.hpp"
#include "emulator/cpu/cpu.hpp"
#include "emulator/tia/registers/motion.hpp"

namespace racebeam {
namespace {

constexpr int kInstructionsPerStep = 25000;
// The clocks are turned back by this much: an even number of lines.
constexpr std::int32_t kEndlessTurn = kEndlessCycle / 2 / (2 * kLineCycles) * (2 * kLineCycles);

}  // namespace

void Console::step(bool draw, bool follow) { impl_->step(draw, follow); }

void Console::Impl::step(bool observed, bool follow) {
  const bool draw = observed || (!follow && render_policy.next_is_drawn());
  if (!follow && render_policy.measures()) {
    const Stopwatch watch;
    run_frame(draw);
    render_policy.record(watch.elapsed());
  } else {
    run_frame(draw);
  }
  undrawn_frames = draw ? 0 : undrawn_frames + 1;
  if (undrawn_frames == tuning::kUndrawnFrames) {
    release_undrawn();
    undrawn_frames = 0;  // counted anew, so that the number stays small
  }
  if (pace != nullptr) pace->frame();
}

void Console::Impl::run_frame(bool draw) {
  FrameState& frame = state().frame;
  const bool opens = !frame.open;
  if (opens) {
    std::swap(pictures.current, pictures.previous);
    board.open_frame();
    frame.greyed = 0;
    frame.open = 1;
  }
  const bool keeps_old_pixels = draw && !pictures.current->is_undrawn && is_own(pictures.current);
  if (!opens || keeps_old_pixels || !step_over(draw)) {
    settle_latches(*pictures.previous);
    FrameStart start = frame_start();
    draw_now(pictures.current);
    run_step(canvas(), start, RenderMode::kDrawn);
    latches.sought |= board.tia.latches_read();
    note_latches(start, kAllPairs);
  }
  if (!frame.open) {
    frame.lines = (3 * state().cycle - state().tia.origin) / kLineClocks;
    frame.greyed = 0;
  } else if (!frame.greyed) {
    board.tia.grey(*pictures.current, state().cycle);
    frame.greyed = 1;
  }
  if (state().cycle >= kEndlessCycle) board.turn_back_clocks(kEndlessTurn);
}

// Runs a frame on a buffer whose pixels will all be overwritten. Returns false, with the machine back at its
// start, if the frame does not fill the whole window, does not close, or should be drawn later and has too
// long a log.
bool Console::Impl::step_over(bool draw) {
  FrameStart start = frame_start();
  std::shared_ptr<FrameBuffer>& current = pictures.current;
  if (!spare.current) std::swap(spare.current, spare.previous);
  std::shared_ptr<FrameBuffer>& place = is_own(current) ? current : spare.current;
  if (!is_own(place)) place = std::make_shared<FrameBuffer>();
  bool closes;
  do closes = run_step(*place, start, draw ? RenderMode::kDrawn : RenderMode::kNone) && !state().frame.open;
  while (reads_unknown_latches(start, draw));
  if (!closes || !board.tia.drew_all() || (!draw && !board.is_recorded())) {
    rewind(start);
    return false;
  }
  note_latches(start, draw ? kAllPairs : latches.sought);
  place->is_undrawn = !draw;
  if (!draw) board.record_step(place->undrawn, start.state.tia, start.state.frame.lines);
  if (&place != &current) current = std::exchange(place, nullptr);
  return true;
}

// Runs a step from `start`. In a few steps, pixels can be seen that the reference draws ahead of the beam.
// Such a step is run once more, access by access. If its pixels are not wanted, returns false instead; the
// caller must rewind.
bool Console::Impl::run_step(FrameBuffer& picture, const FrameStart& start, RenderMode mode) {
  thread_local WriteLog log;
  const FrameBuffer* const other = other_than(picture);
  const auto repeat = [&](RenderMode how) {
    rewind(start);
    board.begin_step(picture, other, log, how, latches.sought);
    interpret(board, kInstructionsPerStep);
  };
  board.begin_step(picture, other, log, mode, latches.sought);
  if (translator == nullptr) {
    interpret(board, kInstructionsPerStep);
  } else if (!translator->run(board, kInstructionsPerStep)) {
    repeat(mode);
  }
  board.end_step();
  if (translator != nullptr) translator->end_step();
  if (!board.needs_exact_step()) return true;
  if (mode == RenderMode::kNone) return false;
  repeat(RenderMode::kExact);
  board.end_step();
  return true;
}

void Console::Impl::rewind(const FrameStart& start) {
  state() = start.state;
  board.cartridge_ram = start.cartridge_ram;
  board.sound = start.sound;
  board.map_memory();
}

// Draws a picture whose pixels were deferred. The machine does not change.
void Console::Impl::draw_now(std::shared_ptr<FrameBuffer>& picture) {
  if (!picture->is_undrawn && picture->rows() >= rows()) return;
  if (!is_own(picture)) picture = own_copy(*picture);
  picture->make_room(rows());
  if (!picture->is_undrawn) return;
  undrawn_frames = 0;
  board.replay(picture->undrawn, *picture, other_than(*picture), RenderMode::kDrawn);
  picture->is_undrawn = false;
}

// Whether the step read latches that were not computed. It must then be run again, from `start`.
bool Console::Impl::reads_unknown_latches(FrameStart& start, bool drew) {
  const Collisions unsought = board.tia.latches_read() & ~latches.sought;
  if (unsought == 0) return false;
  latches.sought |= unsought;
  if (drew && (latches.unknown & unsought) == 0) return false;
  rewind(start);
  settle_latches(*pictures.previous);
  start = frame_start();
  return true;
}

// Called after a step from `start`. looked_for: the pairs whose collisions were computed in it.
void Console::Impl::note_latches(FrameStart& start, Collisions looked_for) {
  if (latches.unknown != 0 && !board.tia.cleared()) {  // they persist
    start.state.tia.collisions = collisions_after(*pictures.previous);
    state().tia.collisions |= start.state.tia.collisions;
    latches.sought = kAllPairs;  // for a game that keeps collisions over frames
  }
  latches.unknown = kAllPairs & ~looked_for & ~state().tia.collisions;
}

// Computes the unknown latches. last: the frame that left them unknown, the last one.
void Console::Impl::settle_latches(FrameBuffer& last) {
  if (latches.unknown == 0) return;
  state().tia.collisions = collisions_after(last);
  latches.unknown = 0;
}

// All latches at the end of a frame that was run without its pixels.
Collisions Console::Impl::collisions_after(FrameBuffer& last) {
  return board.replay(last.undrawn, last, nullptr, RenderMode::kNone);
}

const FrameBuffer* Console::Impl::other_than(const FrameBuffer& picture) const {
  return (&picture == pictures.previous.get() ? pictures.current : pictures.previous).get();
}

std::shared_ptr<FrameBuffer> Console::Impl::own_copy(const FrameBuffer& picture) {
  for (std::shared_ptr<FrameBuffer>* const buffer : {&spare.current, &spare.previous}) {
    if (!is_own(*buffer)) continue;
    **buffer = picture;
    return std::move(*buffer);
  }
  return std::make_shared<FrameBuffer>(picture);
}

// The buffer to draw on: the console's own, not one that a saved state holds too.
FrameBuffer& Console::Impl::canvas() {
  if (!is_own(pictures.current)) pictures.current = own_copy(*pictures.current);
  return *pictures.current;
}

}  // namespace racebeam
