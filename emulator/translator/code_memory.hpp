// Executable memory that is never writable at the same time. It is filled from the front, in whole pages: those that
// are being written can't be run yet, and those that can be run are never written again, so that other threads may be in
// them.
#pragma once

#include <cstddef>

namespace racebeam::translator {

class CodeMemory {
 public:
  explicit CodeMemory(std::size_t size);  // throws std::system_error
  ~CodeMemory();
  CodeMemory(const CodeMemory&) = delete;
  CodeMemory& operator=(const CodeMemory&) = delete;

  // Where to write next, and how much. Null when all is used.
  void* writable() const { return left() == 0 ? nullptr : base_ + used_; }
  std::size_t left() const { return open_ - used_; }

  // Makes the first `size` written bytes executable. Throws std::system_error where that is refused.
  void seal(std::size_t size);

 private:
  char* base_ = nullptr;
  std::size_t size_;
  std::size_t used_ = 0;   // sealed
  std::size_t open_ = 0;   // up to here, pages can be written
};

}  // namespace racebeam::translator
