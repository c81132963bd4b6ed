#include "emulator/tia/line_cache/line_cache.hpp"

#include <atomic>

namespace racebeam {

void LineCache::aim(std::size_t rows) {
  if (is_new_) begin();
  if (!flicker_.found()) sets_[1] = {};
  set_ = &sets_[flicker_.is_turn_of_second() ? 1 : 0];
  set_->resize(rows);
}

void LineCache::begin() {
  is_new_ = false;
  flicker_.begin_frame();
  if (!flicker_.starts_to_count()) return;
  for (LineRecord& record : sets_[0]) record.hashes = {};
}

void LineCache::drop() { sets_ = {}; }

// Numbers are unique over all machines, because pictures can move between machines.
LineNumber LineCache::new_numbers() {
  static std::atomic<LineNumber> last = 0;
  return last.fetch_add(kNumbers, std::memory_order_relaxed) + kNumbers;
}

}  // namespace racebeam
