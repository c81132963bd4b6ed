// Do objects flicker: are they shown in every other frame, so that twice as many can be had? Then rows show what they showed
// two frames before, and lines are remembered in two sets, which take turns (line_cache.hpp).
//
// Now and then a few frames are drawn with one set alone. If rows that must be drawn in two of these frames must be drawn
// again, the same, two frames later, the second set is given a try, and kept until fewer are drawn without it.
#pragma once

#include "emulator/tia/line_cache/line_record.hpp"

namespace racebeam {

class Flicker {
 public:
  void begin_frame();  // one that is drawn

  bool found() const { return found_; }
  bool is_turn_of_second() const { return found_ && odd_ && frame_ > kLast; }

  bool counts() const { return counts_; }  // this frame's rows, all of them
  bool starts_to_count() const { return frame_ == kFirst; }
  void count(LineRecord& drawn);

 private:
  static constexpr int kFirst = 2, kAgain = 4, kLast = 5;  // of the frames with one set: the last two are compared
  static constexpr int kShortPeriod = 64, kLongPeriod = 512;
  static constexpr int kMany = 16;  // rows, in two frames

  void judge();

  int frame_ = 0, period_ = kShortPeriod / 4;    // since the last try, and from one to the next
  int alike_ = 0;                                // rows that were drawn the same again
  int drawn_with_one_ = 0, drawn_with_two_ = 0;  // rows, in two frames
  bool odd_ = false, found_ = false, counts_ = false;
};

}  // namespace racebeam
