// Labels of the code that an assembler writes, whatever the processor.
#pragma once

#include <cstddef>
#include <vector>

namespace racebeam::translator {

// A place in the code. It may be used before it is bound; copies of a label that has been used are the same
// label.
struct Label {
  int id = -1;
};

// What an assembler knows of each label. A label gets its id here when it is first used.
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
