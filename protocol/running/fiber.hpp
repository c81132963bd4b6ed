// A function call that can be suspended at any point and resumed later. It has its own stack
// (fiber_context.hpp). Long work can therefore be straight-line code, and still yield to other sessions.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>

namespace racebeam {

class Fiber {
 public:
  Fiber();
  ~Fiber();  // calls cancel()
  Fiber(const Fiber&) = delete;
  Fiber& operator=(const Fiber&) = delete;

  // Calls `body` until it returns or is suspended. Returns whether it has returned. No other body may be in
  // progress. Throws what `body` throws, and std::bad_alloc without memory for a stack.
  template <typename Body>
  bool start(Body body) {
    const auto call = [](void* context) {
      Body own = std::move(*static_cast<Body*>(context));
      own();
    };
    return start(call, &body);
  }

  // Continues a suspended body, on any thread. Returns whether the body has returned. Throws what the body
  // throws, which ends it. A function that suspends must not use thread_local variables both before and
  // after, because compilers keep their addresses.
  bool resume();

  // Unwinds a suspended body: its suspend() throws. Ignores other exceptions of the body.
  void cancel();

  bool in_progress() const { return run_ != nullptr; }

  // Called by the body: returns to the caller of start() or resume(). It returns to the body when resume() is
  // called. Must not be called within a catch block, because exceptions in flight belong to the thread.
  void suspend();

 private:
  struct Run;

  bool start(void (*body)(void*), void* context);

  std::unique_ptr<Run> run_;  // null: no body is in progress
};

}  // namespace racebeam
