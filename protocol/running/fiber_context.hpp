// Runs a call on its own stack, and switches between that stack and the caller's. Windows does this with its
// own fibers, Linux and macOS with Boost.Context. WebAssembly cannot suspend calls.
#pragma once

#include <memory>

namespace racebeam {

class FiberContext {
 public:
  // The body begins with the first enter(), and throws nothing. Throws std::bad_alloc.
  FiberContext(void (*body)(void*), void* data);
  ~FiberContext();  // the body must have returned, or never have started
  FiberContext(const FiberContext&) = delete;
  FiberContext& operator=(const FiberContext&) = delete;

  void enter();  // on any thread: runs the body until it calls leave() or returns
  void leave();  // called by the body

 private:
  struct Stack;
  std::unique_ptr<Stack> stack_;
};

}  // namespace racebeam
