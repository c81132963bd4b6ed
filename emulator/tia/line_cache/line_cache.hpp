// The lines drawn last, a record for each row of the window. The two picture buffers share them, since most
// rows show what they showed in the frame before; each picture says of its rows by number which line they
// show, so that one that the other has can be copied. Where objects flicker there are two sets of records,
// for even and for odd frames. Derived: not of the machine's state.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "emulator/tia/line_cache/flicker.hpp"
#include "emulator/tia/line_cache/line_record.hpp"

namespace racebeam {

class LineCache {
 public:
  void begin_frame() { is_new_ = true; }
  void aim(std::size_t rows);  // before a frame is drawn, or some more of one
  void drop();

  std::size_t rows() const { return set_->size(); }
  LineRecord& row(std::size_t row) { return (*set_)[row]; }

  // Another line is drawn on its row: is it to be remembered?
  bool is_worthwhile(LineRecord& record) const { return flicker_.counts() || record.is_worthwhile(); }

  // The line of the record has been drawn. Returns its number.
  LineNumber add(LineRecord& record) {
    if ((next_number_ & (kNumbers - 1)) == 0) [[unlikely]]
      next_number_ = new_numbers();
    record.number = next_number_++;
    if (flicker_.counts()) [[unlikely]]
      flicker_.count(record);
    return record.number;
  }

 private:
  // So many at a time. Their first is a multiple of that, and not 0.
  static constexpr LineNumber kNumbers = LineNumber{1} << 32;
  static LineNumber new_numbers();

  void begin();

  std::array<std::vector<LineRecord>, 2> sets_;
  std::vector<LineRecord>* set_ = sets_.data();
  LineNumber next_number_ = 0;
  Flicker flicker_;
  bool is_new_ = true;
};

}  // namespace racebeam
