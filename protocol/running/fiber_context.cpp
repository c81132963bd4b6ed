#include "protocol/running/fiber_context.hpp"

#include <utility>

#include <boost/context/fiber.hpp>

#include "protocol/running/fiber_stack.hpp"
#include "protocol/running/sanitizer_fiber.hpp"

namespace racebeam {
namespace {

namespace context = boost::context;

struct NoAllocator {  // FiberContext owns the stack
  void deallocate(context::stack_context&) {}
};

}  // namespace

struct FiberContext::Stack {
  Stack(void (*call)(void*), void* data)
      : body(std::allocator_arg, whole_memory(), NoAllocator{}, [this, call, data](context::fiber&& from) {
          sanitizer.arrived_in_body();
          caller = std::move(from);
          call(data);
          sanitizer.leaves_body_for_good();
          return std::move(caller);
        }) {}

  context::preallocated whole_memory() {
    context::stack_context place;
    place.size = FiberStack::kBytes;
    place.sp = memory.bottom() + FiberStack::kBytes;
    return {place.sp, place.size, place};
  }

  FiberStack memory;
  SanitizerFiber sanitizer{memory.bottom(), FiberStack::kBytes};
  context::fiber caller;  // the context that runs the body
  context::fiber body;    // suspended, or empty
};

FiberContext::FiberContext(void (*body)(void*), void* data) : stack_(std::make_unique<Stack>(body, data)) {}
FiberContext::~FiberContext() = default;

void FiberContext::enter() {
  stack_->sanitizer.leaves_caller();
  stack_->body = std::move(stack_->body).resume();
  stack_->sanitizer.arrived_in_caller();
}

void FiberContext::leave() {
  Stack& stack = *stack_;
  stack.sanitizer.leaves_body();
  stack.caller = std::move(stack.caller).resume();
  stack.sanitizer.arrived_in_body();
}

}  // namespace racebeam
