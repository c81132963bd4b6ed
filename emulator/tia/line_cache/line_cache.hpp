// The lines drawn last: a record for each row of the window. The two frame buffers share the records, because
// most rows show what they showed in the frame before. Each buffer knows, by number, which line each of its
// rows shows, so that a row can be copied from the other. If objects flicker, there are two sets of records,
// for even and for odd frames. The cache is derived: it is not part of the machine's state.
#pragma once

#include <array>
#include <cstddef>

#include "emulator/base/large_pages.hpp"
#include "emulator/tia/line_cache/flicker_detector.hpp"
#include "emulator/tia/line_cache/line_record.hpp"

namespace racebeam {

class LineCache {
 public:
  void begin_frame() { is_new_ = true; }
  void aim(std::size_t rows);  // before each part of a frame that is drawn
  void drop();
  std::size_t footprint() const {  // bytes of memory
    return sizeof(LineRecord) * (sets_[0].capacity() + sets_[1].capacity());
  }

  std::size_t rows() const { return set_->size(); }
  LineRecord& row(std::size_t row) { return (*set_)[row]; }

  // Begins the record of a line that is drawn. The row after it no longer repeats a known line.
  LineRecord& open(std::size_t row, const TiaRegisters& registers) {
    if (row + 1 < rows()) (*set_)[row + 1].repeats = false;
    LineRecord& record = (*set_)[row];
    record.open(registers);
    return record;
  }

  // Numbers the line that has been drawn and recorded. Returns the number.
  LineNumber add(LineRecord& record) {
    if ((next_number_ & (kNumbers - 1)) == 0) [[unlikely]]
      next_number_ = new_numbers();
    record.number = next_number_++;
    if (flicker_.counts()) [[unlikely]]
      flicker_.count(record);
    return record.number;
  }

 private:
  // How many numbers a machine takes at a time. The first is a multiple of that, and not 0.
  static constexpr LineNumber kNumbers = LineNumber{1} << 32;
  static LineNumber new_numbers();

  void begin();

  std::array<MachineVector<LineRecord>, 2> sets_;
  MachineVector<LineRecord>* set_ = sets_.data();
  LineNumber next_number_ = 0;
  FlickerDetector flicker_;
  bool is_new_ = true;
};

}  // namespace racebeam
