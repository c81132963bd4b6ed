// For WebAssembly, whose calls cannot be suspended: a body returns before start() does.
#include "protocol/running/fiber.hpp"

namespace racebeam {

struct Fiber::Run {};

Fiber::Fiber() = default;
Fiber::~Fiber() = default;

bool Fiber::start(void (*body)(void*), void* context) {
  body(context);
  return true;
}

bool Fiber::resume() { return true; }
void Fiber::cancel() {}
void Fiber::suspend() {}

}  // namespace racebeam
