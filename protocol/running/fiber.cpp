#include "protocol/running/fiber.hpp"

#include <exception>
#include <utility>

#include <boost/context/fiber.hpp>

#include "protocol/running/fiber_stack.hpp"
#include "protocol/running/sanitizer_fiber.hpp"

namespace racebeam {
namespace {

namespace context = boost::context;

struct Cancelled {};  // thrown to unwind the body

struct NoAllocator {  // the Run owns the stack
  void deallocate(context::stack_context&) {}
};

}  // namespace

struct Fiber::Run {
  context::preallocated whole_stack() {
    context::stack_context place;
    place.size = FiberStack::kBytes;
    place.sp = stack.bottom() + FiberStack::kBytes;
    return {place.sp, place.size, place};
  }

  void run(void (*body)(void*), void* context);
  bool go_on();  // returns whether the body has returned

  FiberStack stack;
  SanitizerFiber sanitizer{stack.bottom(), FiberStack::kBytes};
  context::fiber body;         // suspended, or empty
  context::fiber caller;       // the context that runs the body
  std::exception_ptr failure;  // of the body
  bool cancelled = false;
};

void Fiber::Run::run(void (*call)(void*), void* with) {
  body = context::fiber(std::allocator_arg, whole_stack(), NoAllocator{},
                        [this, call, with](context::fiber&& from) {
                          sanitizer.arrived_in_body();
                          caller = std::move(from);
                          try {
                            call(with);
                          } catch (const Cancelled&) {
                          } catch (const std::exception&) {
                            failure = std::current_exception();
                          }
                          sanitizer.leaves_body_for_good();
                          return std::move(caller);
                        });
}

bool Fiber::Run::go_on() {
  sanitizer.leaves_caller();
  body = std::move(body).resume();
  sanitizer.arrived_in_caller();
  return !body;
}

Fiber::Fiber() = default;
Fiber::~Fiber() { cancel(); }

bool Fiber::start(void (*body)(void*), void* context) {
  run_ = std::make_unique<Run>();
  run_->run(body, context);
  return resume();
}

bool Fiber::resume() {
  if (!run_->go_on()) return false;
  const std::exception_ptr failure = std::exchange(run_, nullptr)->failure;
  if (failure) std::rethrow_exception(failure);
  return true;
}

void Fiber::suspend() {
  Run& run = *run_;
  run.sanitizer.leaves_body();
  run.caller = std::move(run.caller).resume();
  run.sanitizer.arrived_in_body();
  if (run.cancelled) throw Cancelled{};
}

void Fiber::cancel() {
  if (!run_) return;
  run_->cancelled = true;
  while (!run_->go_on()) continue;
  run_.reset();
}

}  // namespace racebeam
