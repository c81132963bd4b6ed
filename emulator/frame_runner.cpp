// Running a frame, with its pixels or without (docs/spec/tia.md, 2). A frame whose pixels nobody has asked
// for leaves its start in the picture, and is run again when somebody asks.
#include "emulator/console_impl.hpp"
#include "emulator/cpu/cpu.hpp"
#include "emulator/tia/registers/motion.hpp"

namespace racebeam {
namespace {

constexpr int kInstructionsPerStep = 25000;
constexpr std::int32_t kEndlessTurn = kEndlessCycle / 2 / (2 * kLineCycles) * (2 * kLineCycles);  // an even number of lines

}  // namespace

void Console::Impl::step(bool observed, bool follow) {
  const bool deferred = !observed && !follow;  // how the next ones are to be run
  const bool draw = observed || (deferred && render_policy.next_is_drawn());
  FrameState& frame = state().frame;
  const bool opens = !frame.open;
  if (opens) {
    std::swap(pictures.current, pictures.previous);
    board.open_frame();
    frame.greyed = 0;
    frame.open = 1;
  }
  FrameStart start = frame_start();
  const bool keeps_old_pixels = draw && !pictures.current->is_undrawn && is_own(pictures.current);
  if (!opens || keeps_old_pixels || !step_over(start, draw, deferred)) {
    settle_latches();
    start = frame_start();
    draw_now(pictures.current);
    run_step(canvas(), start, RenderMode::kDrawn);
    if (deferred && draw) render_policy.record(board.tia.work());
    latches.sought |= board.tia.asked();
    note_latches(start, kAllPairs);
  }
  // The agent reads RAM over the bus after each step (docs/spec/console.md, 4).
  state().cpu.latch = state().riot.ram.back();
  if (!frame.open) {
    frame.lines = (3 * state().cycle - state().tia.origin) / kLineClocks;
    frame.greyed = 0;
  } else if (!frame.greyed) {
    board.tia.grey(*pictures.current, state().cycle);
    frame.greyed = 1;
  }
  if (state().cycle >= kEndlessCycle) board.turn_back_clocks(kEndlessTurn);
  if (pace != nullptr) pace->frame();
}

// Runs a frame without a look at what its picture shows so far. It must fill the whole window: false if it does not, or
// does not close, and the machine stands at its start again.
bool Console::Impl::step_over(FrameStart& start, bool draw, bool deferred) {
  std::shared_ptr<FrameBuffer>& current = pictures.current;
  if (!spare.current) std::swap(spare.current, spare.previous);
  std::shared_ptr<FrameBuffer>& place = is_own(current) ? current : spare.current;
  if (!is_own(place)) place = std::make_shared<FrameBuffer>();
  bool closes;
  do closes = run_step(*place, start, draw ? RenderMode::kDrawn : RenderMode::kNone) && !state().frame.open;
  while (reads_unknown_latches(start, draw));
  if (!closes || !board.tia.drew_all()) {
    rewind(start);
    return false;
  }
  if (deferred) render_policy.record(board.tia.work());
  note_latches(start, draw ? kAllPairs : latches.sought);
  place->is_undrawn = !draw;
  if (!draw) place->undrawn = start;
  if (&place != &current) current = std::exchange(place, nullptr);
  return true;
}

// From `start` on. What the reference draws ahead of the beam is seen in few steps: such a one is run once more, access
// by access; but false, and all is left as it is, if its pixels are not wanted.
bool Console::Impl::run_step(FrameBuffer& picture, const FrameStart& start, RenderMode mode) {
  thread_local WriteLog log;
  const FrameBuffer* const other =
      (&picture == pictures.previous.get() ? pictures.current : pictures.previous).get();
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

// Gives a picture its pixels. The machine is the same afterwards.
void Console::Impl::draw_now(std::shared_ptr<FrameBuffer>& picture) {
  if (!picture->is_undrawn && picture->rows() >= rows()) return;
  if (!is_own(picture)) picture = own_copy(*picture);
  picture->make_room(rows());
  if (!picture->is_undrawn) return;
  const FrameStart now = frame_start();
  rewind(picture->undrawn);
  run_step(*picture, picture->undrawn, RenderMode::kDrawn);
  picture->is_undrawn = false;
  rewind(now);
}

// Has the step read latches that nobody has looked for? Then it is to be run again, from `start`.
bool Console::Impl::reads_unknown_latches(FrameStart& start, bool drew) {
  const Collisions unsought = board.tia.asked() & ~latches.sought;
  if (unsought == 0) return false;
  latches.sought |= unsought;
  if (drew && (latches.unknown & unsought) == 0) return false;
  rewind(start);
  settle_latches();
  start = frame_start();
  return true;
}

// After a step from `start` on in which these pairs were looked for.
void Console::Impl::note_latches(FrameStart& start, Collisions looked_for) {
  const bool persists = latches.unknown != 0 && !board.tia.cleared();
  if (persists) {
    const FrameStart now = frame_start();
    rewind(start);
    settle_latches();
    start = frame_start();
    rewind(now);
    state().tia.collisions |= start.state.tia.collisions;
    latches.sought = kAllPairs;  // a game that keeps them from frame to frame
  }
  latches.unknown = kAllPairs & ~looked_for & ~state().tia.collisions;
  if (latches.unknown != 0) latches.step = start;
}

// Runs the last step again, with a look at all pairs.
void Console::Impl::settle_latches() {
  if (latches.unknown == 0) return;
  const FrameStart now = frame_start();
  const Collisions sought = std::exchange(latches.sought, kAllPairs);
  rewind(latches.step);
  run_step(*pictures.current, latches.step, RenderMode::kNone);
  const Collisions found = state().tia.collisions;
  rewind(now);
  state().tia.collisions = found;
  latches.sought = sought;
  latches.unknown = 0;
}

std::shared_ptr<FrameBuffer> Console::Impl::own_copy(const FrameBuffer& picture) {
  for (std::shared_ptr<FrameBuffer>* const kept : {&spare.current, &spare.previous}) {
    if (!is_own(*kept)) continue;
    **kept = picture;
    return std::move(*kept);
  }
  return std::make_shared<FrameBuffer>(picture);
}

// The picture that is drawn on: the console's own, not one that a snapshot holds too.
FrameBuffer& Console::Impl::canvas() {
  if (!is_own(pictures.current)) pictures.current = own_copy(*pictures.current);
  return *pictures.current;
}

}  // namespace racebeam
