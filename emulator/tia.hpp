// The TIA's picture side: plays the log of register accesses on the beam (spec: tia.md, sections 4 and 7 to 9).
// Sound, WSYNC, VSYNC and the paddles' capacitors, which the CPU sees at once, are the board's.
#pragma once

#include <cstdint>

#include "emulator/beam.hpp"
#include "emulator/state.hpp"
#include "emulator/write_log.hpp"

namespace racebeam {

class Tia {
 public:
  Tia(TiaState& state, const FrameState& frame, const Video& video)
      : tia_(state), frame_(frame), video_(video), beam_(state, video) {}

  WriteLog log;

  void begin_frame();                       // the cursor, and the colour loss of PAL (tia.md, section 12)
  void begin_step(Picture& picture);        // an empty log; pixels go to `picture`
  void catch_up(std::int32_t cycle);        // play all that was written, and draw up to `cycle`
  void end_step(std::int32_t last_access);  // the same, and leave the picture exact if it stopped inside the window
  void forget() { beam_.forget(); }         // the registers were replaced as a whole
  void grey(Picture& picture, std::int32_t cycle) const;  // rows not drawn when a step ended open

 private:
  void play_until(std::size_t end);
  void play(const TiaAccess& access);
  bool play_line(std::size_t end);
  std::size_t gather_events(std::size_t end, LineRecord& line) const;
  void recall_line(std::size_t next);
  void draw_line(std::size_t next, LineRecord& line);

  // Draws what stood before a write at `clock`, if the write changes anything; remembers how far the beam is.
  template <class T>
  bool assign(T& reg, T value, std::int32_t clock, std::uint8_t objects);
  void draw_to(std::int32_t clock);
  void reach(std::int32_t clock) { reached_ = clock > reached_ ? clock : reached_; }

  int line_cycle(std::int32_t cycle) const;
  std::uint8_t strobe_position(std::int32_t clock, int in_blank, int delay) const;
  void write_color(unsigned which, std::uint8_t value, std::int32_t clock);
  void write_nusiz(unsigned which, std::uint8_t value, std::int32_t clock);
  void write_ctrlpf(std::uint8_t value, std::int32_t clock);
  void write_playfield(unsigned which, std::uint8_t value, const TiaAccess& access);
  void write_graphics(unsigned which, std::uint8_t value, std::int32_t clock);
  void write_vdel(unsigned which, std::uint8_t value, std::int32_t clock);
  void write_ball(std::uint8_t enabled, std::uint8_t old_enabled, std::uint8_t vdel, std::int32_t clock);
  void write_resmp(unsigned which, std::uint8_t value, std::int32_t clock);
  void write_hmm0(std::uint8_t motion, std::int32_t clock);
  void strobe_player(unsigned which, std::int32_t clock);
  void strobe_missile(unsigned which, std::int32_t clock);
  void strobe_ball(std::int32_t clock);
  void strobe_hmove(const TiaAccess& access);
  void clear_collisions(std::int32_t clock);
  void show_cosmic_normally();

  std::uint8_t color_loss() const { return video_.pal ? frame_.lines & 1 : 0; }

  TiaState& tia_;
  const FrameState& frame_;
  const Video& video_;
  Beam beam_;
  std::size_t played_ = 0;
  bool drawn_already_ = false;     // registers change, but the pixels are there
  std::int32_t reached_ = 0;       // the beam as the reference has it: ours may be behind, with the same registers
  TiaState at_begin_;              // of the step, for playing it again
};

}  // namespace racebeam
