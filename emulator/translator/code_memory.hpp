// Executable memory that is never writable at the same time (W^X). A thread that has a CodeWriting fills it
// from the front, in whole pages. Pages that are being written are not executed yet, and executable pages are
// never written again. Other threads may therefore execute them at any time, without a barrier: no processor
// has fetched from them before they were executable.
#pragma once

#include <cstddef>

#include "system/pages.hpp"

namespace racebeam::translator {

class CodeMemory {
 public:
  explicit CodeMemory(std::size_t size);  // throws std::system_error

  // Where to write next, and how many bytes may be written. Null when the memory is full.
  void* writable() const { return left() == 0 ? nullptr : pages_.data() + used_; }
  std::size_t left() const { return pages_.size() - used_; }
  std::size_t size() const { return pages_.size(); }

  // Makes the first `size` written bytes executable, with the rest of their last page. Returns how many bytes
  // these are. Throws std::system_error if the system refuses that.
  std::size_t seal(std::size_t size);

 private:
  Pages pages_;
  std::size_t used_ = 0;  // bytes that are executable
};

}  // namespace racebeam::translator
