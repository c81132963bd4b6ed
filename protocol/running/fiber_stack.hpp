// Memory for the stack of a fiber: with a guard page below it, and kept for the next fiber of the thread.
#pragma once

#include <cstddef>

namespace racebeam {

class FiberStack {
 public:
  FiberStack();  // throws std::bad_alloc
  ~FiberStack();
  FiberStack(const FiberStack&) = delete;
  FiberStack& operator=(const FiberStack&) = delete;

  std::byte* bottom() const { return bottom_; }

  // Address space. The system provides memory for the pages that are touched, which are mostly three.
  static constexpr std::size_t kBytes = std::size_t{1} << 18;

 private:
  std::byte* bottom_;
};

}  // namespace racebeam
