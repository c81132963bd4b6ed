// The TIA's picture: plays the log of register writes on the beam, line by line (docs/spec/tia.md, 4 to 6).
// The board handles what the CPU sees at once: sound, WSYNC, VSYNC and the paddles' capacitors.
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

  void begin_frame();  // docs/spec/tia.md, 12: the cursor, and the colour loss of PAL

  // picture: receives the pixels. log: receives the writes. RenderMode::kExact: the picture shows at every
  // access what the reference has drawn ahead of the beam. The caller must then play each write, and touch()
  // each read, before the next. RenderMode::kNone: only collisions of the pairs `sought` are computed.
  void begin_step(FrameBuffer& picture, const FrameBuffer* other, WriteLog& log, RenderMode mode,
                  Collisions sought);
  void play_log(std::int32_t cycle) { play_log(cycle, kWholePicture); }  // all that was written up to `cycle`
  void empty_log(std::int32_t cycle);  // the same, and empties the log, whose cycles then count from `cycle`
  void touch(std::int32_t cycle);      // an access that changes no register: draws up to it
  void catch_up(std::int32_t cycle);   // plays all writes, and draws up to `cycle`
  void find_collisions(std::int32_t cycle, Collisions latches);  // computes these latches as of `cycle`
  Collisions latches_read() const { return latches_read_; }      // latches that have been read in this step
  bool cleared() const { return beam_.cleared(); }               // whether CXCLR was written in this step
  bool drew_all() const { return tia_.cursor >= beam_.end(); }   // whether the window is complete
  // Like catch_up(), at the end of a picture. Returns false if an access that is not in the log may have left
  // visible pixels.
  bool end_picture(std::int32_t cycle);
  // Whether a picture that stops at `cycle` would show pixels that were drawn ahead of the beam.
  bool stopped_inside(std::int32_t cycle) const;
  void rebuild();  // called after the registers were replaced: recomputes what is derived from them
  void forget_lines() { beam_.forget_lines(); }
  std::size_t footprint_of_lines() const { return beam_.footprint_of_lines(); }  // bytes of memory
  // Greys the rows that were not drawn when a step ended open.
  void grey(FrameBuffer& picture, std::int32_t cycle) const;

 private:
  static constexpr Collisions kWholePicture = 0xFFFF;  // a value of `latches`: more than collisions

  // Writes that have not been played, from `first` to `last`.
  struct Pending {
    const std::uint32_t *first = nullptr, *last = nullptr;
    unsigned control = 0;  // the objects that they may enable (bit n: Object n)
    unsigned filled = 0;   // the players that they give graphics
    bool clears = false;   // there is a CXCLR
  };

  bool is_settled(Collisions latches);
  bool play_log(std::int32_t cycle, Collisions latches);
  bool follow_log();
  void play(const std::uint32_t* next);
  void play_rest(const std::uint32_t* next);
  void skip(const std::uint32_t* next);
  void replay(const std::uint32_t* next);
  const std::uint32_t* end_of_unseen() const;
  bool at_line() const;
  std::uint32_t line_origin() const;
  bool take_lines(Collisions latches);
  bool may_recur(std::uint32_t origin);
  bool keeps_latches(const LineRecord& record, std::uint32_t origin, Collisions latches) const;
  bool recall_lines(std::uint32_t& origin, Collisions latches);
  void play_recalled(const std::uint32_t* next, LineRecord& record);
  bool draw_line(std::uint32_t origin);
  bool ends_early(const std::uint32_t* next, std::uint32_t origin);
  void close_record();

  TiaState& tia_;
  const FrameState& frame_;
  const Video& video_;
  Beam beam_;
  WriteLog* log_ = nullptr;
  const std::uint32_t* played_ = nullptr;  // entries up to here have been played
  Pending pending_;
  LineRecord* recorded_ = nullptr;  // the cursor's line, as far as it has been drawn
  Collisions latches_read_ = 0;
  bool watches_ = false;  // objects of a sought pair may meet, in a step without pixels
  // The clock that the reference's beam has reached; ours may be behind, with the same registers.
  std::int32_t reached_ = 0;
};

}  // namespace racebeam
