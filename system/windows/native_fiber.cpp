#include "system/program/native_fiber.hpp"

#include <windows.h>

#include <new>

namespace racebeam {

NativeFiber::NativeFiber(std::size_t stack_bytes)
    : fiber_(CreateFiberEx(0, stack_bytes, FIBER_FLAG_FLOAT_SWITCH, run, this)) {
  if (fiber_ == nullptr) throw std::bad_alloc();
}

NativeFiber::~NativeFiber() { DeleteFiber(fiber_); }

void NativeFiber::set_body(void (*body)(void*), void* data) {
  body_ = body;
  data_ = data;
}

// A thread becomes a fiber, and stays one.
void NativeFiber::enter() {
  if (IsThreadAFiber() == FALSE && ConvertThreadToFiberEx(nullptr, FIBER_FLAG_FLOAT_SWITCH) == nullptr)
    throw std::bad_alloc();
  caller_ = GetCurrentFiber();
  SwitchToFiber(fiber_);
}

void NativeFiber::leave() { SwitchToFiber(caller_); }

// Does not return, since a fiber that returns ends its thread.
void NativeFiber::run(void* self) {
  auto& own = *static_cast<NativeFiber*>(self);
  for (;;) {
    own.body_(own.data_);
    own.leave();
  }
}

}  // namespace racebeam
