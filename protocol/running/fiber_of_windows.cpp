#include <exception>
#include <utility>
#include <vector>

#include "protocol/running/fiber.hpp"
#include "protocol/running/fiber_stack.hpp"
#include "system/program/native_fiber.hpp"

namespace racebeam {
namespace {

struct Cancelled {};  // thrown to unwind the body

using Native = std::unique_ptr<NativeFiber>;

constexpr std::size_t kMostSpareFibers = 4;  // of a thread
thread_local std::vector<Native> spare_fibers;

Native take_fiber() {
  if (spare_fibers.empty()) return std::make_unique<NativeFiber>(FiberStack::kBytes);
  Native native = std::move(spare_fibers.back());
  spare_fibers.pop_back();
  return native;
}

void put_fiber(Native native) {
  if (spare_fibers.size() < kMostSpareFibers) spare_fibers.push_back(std::move(native));
}

}  // namespace

struct Fiber::Run {
  Run(void (*call)(void*), void* with) : body(call), context(with) {
    native->set_body([](void* run) { static_cast<Run*>(run)->work(); }, this);
  }
  ~Run() { put_fiber(std::move(native)); }

  void work() {
    try {
      body(context);
    } catch (const Cancelled&) {
    } catch (const std::exception&) {
      failure = std::current_exception();
    }
    done = true;
  }

  bool go_on() {  // returns whether the body has returned
    native->enter();
    return done;
  }

  Native native = take_fiber();
  void (*const body)(void*);
  void* const context;
  std::exception_ptr failure;  // of the body
  bool cancelled = false, done = false;
};

Fiber::Fiber() = default;
Fiber::~Fiber() { cancel(); }

bool Fiber::start(void (*body)(void*), void* context) {
  run_ = std::make_unique<Run>(body, context);
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
  run.native->leave();
  if (run.cancelled) throw Cancelled{};
}

void Fiber::cancel() {
  if (!run_) return;
  run_->cancelled = true;
  while (!run_->go_on()) continue;
  run_.reset();
}

}  // namespace racebeam
