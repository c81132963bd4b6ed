// A call on a stack of its own, and the switches between that stack and its caller's. Windows has a source of
// its own. Calls in WebAssembly cannot be suspended.
#pragma once

#include <memory>

namespace racebeam {

class FiberContext {
 public:
  // The body begins with the first enter(), and throws nothing. Throws std::bad_alloc.
  FiberContext(void (*body)(void*), void* data);
  ~FiberContext();  // the body must have returned, or never have begun
  FiberContext(const FiberContext&) = delete;
  FiberContext& operator=(const FiberContext&) = delete;

  void enter();  // on any thread: goes on with the body until it calls leave() or has returned
  void leave();  // called by the body

 private:
  struct Stack;
  std::unique_ptr<Stack> stack_;
};

}  // namespace racebeam
