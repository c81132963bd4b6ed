// Memory for the stack of a fiber, with a guard page below it. Released stacks are reused by the thread's
// next fibers.
#pragma once

#include <cstddef>

#include "system/pages.hpp"

namespace racebeam {

class FiberStack {
 public:
  FiberStack();  // throws std::bad_alloc
  ~FiberStack();
  FiberStack(const FiberStack&) = delete;
  FiberStack& operator=(const FiberStack&) = delete;

  std::byte* bottom() const { return bottom_; }

  // Bytes of address space. The system provides memory only for pages that are used, usually three.
  static constexpr std::size_t kBytes = std::size_t{1} << 18;

 private:
  Pages pages_;
  std::byte* bottom_;
};

}  // namespace racebeam
