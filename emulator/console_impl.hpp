// The implementation of Console, in console.cpp and frame_runner.cpp.
#pragma once

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "emulator/base/stopwatch.hpp"
#include "emulator/board/board.hpp"
#include "emulator/console.hpp"
#include "emulator/policies/deferred_render_policy.hpp"
#include "emulator/translator/translator.hpp"

namespace racebeam {

// The machine before a step; the TIA has begun the frame already.
struct FrameStart {
  State state;
  std::vector<std::uint8_t> cartridge_ram;
  Sound sound;
};

struct Console::Impl {
  Impl(std::shared_ptr<const Rom> rom, const Properties& given, PowerOn& source, CpuKind kind, Pace* paced_by)
      : properties(given),
        power_on(source),
        pace(paced_by),
        board(std::move(rom), given),
        format(given.format),
        translator(Translator::make(board, kind)) {}

  Properties properties;
  PowerOn& power_on;
  Pace* const pace;  // null: none
  Board board;
  Format format;
  FrameBuffers pictures;
  FrameBuffers spare;  // buffers of the console's own that a restored state's have replaced, or null
  // Collisions are computed for all pairs of objects where the picture is drawn, and elsewhere only for the
  // pairs that the game has read so far. The other latches are computed before the state is read.
  struct {
    Collisions sought = 0;
    Collisions unknown = 0;  // latches of the state that have not been computed
  } latches;

  DeferredRenderPolicy render_policy{policies_are_fixed(), delay_of_probes()};
  int undrawn_frames = 0;  // since the last picture was drawn

  const std::unique_ptr<Translator> translator;  // null: the interpreter executes everything

  State& state() { return board.state; }
  std::size_t rows() const { return static_cast<std::size_t>(height()); }
  std::size_t picture_size() const { return rows() * kLinePixels; }
  int height() const { return std::max(board.video.height, 200); }

  void power_up();
  void set_timer();
  void reset();
  void blank(std::shared_ptr<FrameBuffer>& picture);
  Format detect_format();
  void take(const FrameBuffers& others);
  void release_undrawn();
  static unsigned delay_of_probes();
  void check_ram_size(std::span<const std::uint8_t> cartridge_ram) const;

  // frame_runner.cpp
  void step(bool observed, bool follow);
  void run_frame(bool draw);
  bool step_over(bool draw);
  bool run_step(FrameBuffer& picture, const FrameStart& start, RenderMode mode);
  FrameStart frame_start() const { return {board.state, board.cartridge_ram, board.sound}; }
  bool reads_unknown_latches(FrameStart& start, bool drew);
  void note_latches(FrameStart& start, Collisions looked_for);
  void settle_latches(FrameBuffer& last);
  Collisions collisions_after(FrameBuffer& last);
  void rewind(const FrameStart& start);
  void draw_now(std::shared_ptr<FrameBuffer>& picture);
  std::shared_ptr<FrameBuffer> own_copy(const FrameBuffer& picture);
  const FrameBuffer* other_than(const FrameBuffer& picture) const;
  FrameBuffer& canvas();
};

}  // namespace racebeam
