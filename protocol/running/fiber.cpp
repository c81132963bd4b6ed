#include "protocol/running/fiber.hpp"

#include <exception>
#include <utility>

#include "protocol/running/fiber_context.hpp"

namespace racebeam {
namespace {

struct Cancelled {};  // thrown to unwind the body

}  // namespace

struct Fiber::Run {
  Run(void (*call)(void*), void* with) : body(call), data(with) {}

  void work() {
    try {
      body(data);
    } catch (const Cancelled&) {
    } catch (const std::exception&) {
      failure = std::current_exception();
    }
    done = true;
  }

  bool resume() {  // returns whether the body has returned
    context.enter();
    return done;
  }

  void (*const body)(void*);
  void* const data;
  std::exception_ptr failure;  // of the body
  bool cancelled = false, done = false;
  FiberContext context{[](void* run) { static_cast<Run*>(run)->work(); }, this};
};

Fiber::Fiber() = default;
Fiber::~Fiber() { cancel(); }

bool Fiber::start(void (*body)(void*), void* context) {
  run_ = std::make_unique<Run>(body, context);
  return resume();
}

bool Fiber::resume() {
  if (!run_->resume()) return false;
  const std::exception_ptr failure = std::exchange(run_, nullptr)->failure;
  if (failure) std::rethrow_exception(failure);
  return true;
}

void Fiber::suspend() {
  Run& run = *run_;
  run.context.leave();
  if (run.cancelled) throw Cancelled{};
}

void Fiber::cancel() {
  if (!run_) return;
  run_->cancelled = true;
  while (!run_->resume()) continue;
  run_.reset();
}

}  // namespace racebeam
