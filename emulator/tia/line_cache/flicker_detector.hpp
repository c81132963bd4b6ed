// Detects flicker: objects that a game shows in every other frame, so that it can show twice as many. Rows
// then show what they showed two frames before. Lines are recorded in two sets, which alternate
// (line_cache.hpp).
//
// From time to time, a few frames are drawn with one set. If enough rows must be drawn again two frames
// later, with the same content, the second set is tried. It is kept until fewer rows are drawn without it.
#pragma once

#include "emulator/policies/tuning.hpp"
#include "emulator/tia/line_cache/line_record.hpp"

namespace racebeam {

class FlickerDetector {
 public:
  void begin_frame();  // of a frame that is drawn

  bool found() const { return found_; }
  bool is_turn_of_second() const { return found_ && odd_ && frame_ > kLast; }

  bool counts() const { return counts_; }  // whether all rows of this frame are counted
  bool starts_to_count() const { return frame_ == kFirst; }
  void count(LineRecord& record);

 private:
  // The frames of a try, by their number in the period: rows are hashed from kFirst on, and compared with
  // those of two frames before from kAgain to kLast. These are not numbers to tune: objects flicker with a
  // period of two frames. The first two only fill the one set with the lines of both kinds of frames.
  static constexpr int kFirst = 2, kAgain = 4, kLast = 5;

  void judge();

  // The frames since the last try, and those between two tries.
  int frame_ = 0, period_ = tuning::kFirstFlickerPeriod;
  int alike_ = 0;                                // rows that were drawn again with the same content
  int drawn_with_one_ = 0, drawn_with_two_ = 0;  // rows, in two frames
  bool odd_ = false, found_ = false, counts_ = false;
};

}  // namespace racebeam
