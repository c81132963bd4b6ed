// The TIA's picture side: plays the log of register accesses on the beam, line by line (spec: tia.md, sections 4 to 6).
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
  void rewind(const AccessList& accesses);  // plays these, from the beginning
  void play_until(std::size_t end);
  void play(std::size_t next);
  bool play_line(std::size_t end);
  std::size_t end_of_known_line(const LineRecord& known, std::size_t end) const;
  void recall_line(std::size_t next);
  void draw_line(std::size_t next, std::uint8_t count);
  bool draw_new_line(std::size_t end);
  std::size_t gather_events(std::size_t end, LineRecord& line, std::uint8_t& count) const;

  TiaState& tia_;
  const FrameState& frame_;
  const Video& video_;
  Beam beam_;
  const AccessList* accesses_ = nullptr;
  std::size_t played_ = 0;         // of them
  std::int32_t reached_ = 0;       // the beam as the reference has it: ours may be behind, with the same registers
  TiaState at_begin_;              // of the step, for playing it again
};

}  // namespace racebeam
