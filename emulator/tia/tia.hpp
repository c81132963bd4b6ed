// The TIA's picture side: plays the log of register writes on the beam, line by line (docs/spec/tia.md, 4 to
// 6). Sound, WSYNC, VSYNC and the paddles' capacitors, which the CPU sees at once, are the board's.
#pragma once

#include <cstdint>

#include "emulator/state/state.hpp"
#include "emulator/tia/beam.hpp"
#include "emulator/tia/registers/write_log.hpp"

namespace racebeam {

class Tia {
 public:
  Tia(TiaState& state, const FrameState& frame, const Video& video)
      : tia_(state), frame_(frame), video_(video), beam_(state, video) {}

  void begin_frame();  // the cursor, and the colour loss of PAL (docs/spec/tia.md, 12)

  // Pixels go to `picture`, writes come in `log`. RenderMode::kExact: the picture shows what the reference has drawn ahead
  // of the beam at every access; then each write must be played, and each read touched, before the next.
  // RenderMode::kNone: of collisions, only the pairs `sought` are found.
  void begin_step(FrameBuffer& picture, const FrameBuffer* other, WriteLog& log, RenderMode mode,
                  Collisions sought);
  void play_log(std::int32_t cycle) { play_log(cycle, kWholePicture); }  // all that was written up to `cycle`
  void empty_log(std::int32_t cycle);    // the same, and makes room; its cycles count from `cycle` from now on
  void touch(std::int32_t cycle);        // an access that changes nothing: draws up to it
  void catch_up(std::int32_t cycle);     // plays all, and draws up to `cycle`
  void find_collisions(std::int32_t cycle, Collisions asked);  // these latches stand as they do at `cycle`
  Collisions asked() const { return asked_; }      // latches that have been read in this step
  bool cleared() const { return beam_.cleared(); }  // all latches, in this step
  std::uint32_t work() const { return work_ + 250 * beam_.spans(); }  // of this step: instructions, more or less
  bool drew_all() const { return tia_.cursor >= beam_.end(); }  // of the window
  // The same, where nothing follows. False if an access that is not in the log may have left something to be seen.
  bool end_picture(std::int32_t cycle);
  bool stopped_inside(std::int32_t cycle) const;  // would a picture that stops here show what was drawn ahead?
  void forget() { beam_.forget(); }      // the registers were replaced as a whole
  void forget_lines() { beam_.forget_lines(); }
  void grey(FrameBuffer& picture, std::int32_t cycle) const;  // rows not drawn when a step ended open

 private:
  static constexpr Collisions kWholePicture = 0xFFFF;  // asked: not collisions alone

  bool play_log(std::int32_t cycle, Collisions asked);
  bool follow_log();
  void play(const std::uint32_t* next);
  void skip(const std::uint32_t* next);
  const std::uint32_t* end_of_unseen() const;
  bool at_line() const;
  std::uint32_t line_origin() const;
  bool take_lines(Collisions asked);
  bool recall_lines(std::uint32_t& origin, Collisions asked);
  void play_recalled(const std::uint32_t* next, LineRecord& record);
  bool draw_line(std::uint32_t origin);
  bool record_writes(std::uint32_t origin);
  void close_record();

  TiaState& tia_;
  const FrameState& frame_;
  const Video& video_;
  Beam beam_;
  WriteLog* log_ = nullptr;
  const std::uint32_t* played_ = nullptr;  // of its entries, up to here
  LineRecord* recorded_ = nullptr;  // the cursor's line, as far as it has been drawn
  Collisions asked_ = 0;
  std::uint32_t work_ = 0;
  bool watches_ = false;      // something may meet, in a step without pixels
  std::int32_t reached_ = 0;  // the beam as the reference has it: ours may be behind, with the same registers
};

}  // namespace racebeam
