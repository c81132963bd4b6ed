// Calls on a stack of their own, by the fibers of Windows, which the unwinder of exceptions knows.
// Boost.Context's stacks end the process there when a body throws.
#pragma once

#include <cstddef>

namespace racebeam {

class NativeFiber {
 public:
  explicit NativeFiber(std::size_t stack_bytes);  // throws std::bad_alloc
  ~NativeFiber();                                 // no body may be in progress
  NativeFiber(const NativeFiber&) = delete;
  NativeFiber& operator=(const NativeFiber&) = delete;

  // Gives it a body, for the next enter(). The body throws nothing.
  void set_body(void (*body)(void*), void* data);

  void enter();  // on any thread: runs the body until it calls leave() or returns
  void leave();  // called by the body

 private:
  static void run(void* self);

  void* fiber_ = nullptr;
  void* caller_ = nullptr;
  void (*body_)(void*) = nullptr;
  void* data_ = nullptr;
};

}  // namespace racebeam
