#include <cstddef>
#include <utility>
#include <vector>

#include "protocol/running/fiber_context.hpp"
#include "protocol/running/fiber_stack.hpp"
#include "system/program/native_fiber.hpp"

namespace racebeam {
namespace {

using Native = std::unique_ptr<NativeFiber>;

constexpr std::size_t kMaxSpareFibers = 4;  // of a thread
thread_local std::vector<Native> spare_fibers;

Native take_fiber() {
  if (spare_fibers.empty()) return std::make_unique<NativeFiber>(FiberStack::kBytes);
  Native native = std::move(spare_fibers.back());
  spare_fibers.pop_back();
  return native;
}

void put_fiber(Native native) {
  if (spare_fibers.size() < kMaxSpareFibers) spare_fibers.push_back(std::move(native));
}

}  // namespace

struct FiberContext::Stack {
  ~Stack() { put_fiber(std::move(native)); }

  Native native = take_fiber();
};

FiberContext::FiberContext(void (*body)(void*), void* data) : stack_(std::make_unique<Stack>()) {
  stack_->native->set_body(body, data);
}

FiberContext::~FiberContext() = default;

void FiberContext::enter() { stack_->native->enter(); }
void FiberContext::leave() { stack_->native->leave(); }

}  // namespace racebeam
