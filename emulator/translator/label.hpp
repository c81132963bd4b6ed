// Labels in the code that an assembler writes, for any processor.
#pragma once

#include <cstddef>
#include <vector>

namespace racebeam::translator {

// A place in the code. Jumps may use it before it is bound. Copies of a label that has been used are the same
// label.
struct Label {
  int id = -1;
};

// What an assembler knows about each label. A label gets its id here when it is first used.
template <class Target>
class LabelTable {
 public:
  Target& operator[](Label& label) {
    if (label.id < 0) {
      label.id = static_cast<int>(targets_.size());
      targets_.emplace_back();
    }
    return targets_[static_cast<std::size_t>(label.id)];
  }

 private:
  std::vector<Target> targets_;
};

}  // namespace racebeam::translator
