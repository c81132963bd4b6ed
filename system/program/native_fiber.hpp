// Runs functions on a separate stack, by the fibers of Windows, which the unwinder of exceptions supports.
// With Boost.Context's stacks, the process ends there when a body throws.
#pragma once

#include <cstddef>

namespace racebeam {

class NativeFiber {
 public:
  explicit NativeFiber(std::size_t stack_bytes);  // throws std::bad_alloc
  ~NativeFiber();                                 // a body must not be in progress
  NativeFiber(const NativeFiber&) = delete;
  NativeFiber& operator=(const NativeFiber&) = delete;

  // Sets the body that the next enter() runs. It must not throw.
  void set_body(void (*body)(void*), void* data);

  void enter();  // runs the body until it calls leave() or returns; on any thread
  void leave();  // called by the body

 private:
  static void run(void* self);

  void* fiber_ = nullptr;
  void* caller_ = nullptr;
  void (*body_)(void*) = nullptr;
  void* data_ = nullptr;
};

}  // namespace racebeam
