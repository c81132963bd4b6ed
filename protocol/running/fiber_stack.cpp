#include "protocol/running/fiber_stack.hpp"

#include <new>
#include <system_error>
#include <utility>
#include <vector>

namespace racebeam {
namespace {

constexpr std::size_t kMaxSpare = 4;  // of a thread; a session in progress holds one

Pages new_stack() try {
  Pages pages(page_size() + FiberStack::kBytes);
  pages.forbid(0, page_size());
  return pages;
} catch (const std::system_error&) {
  throw std::bad_alloc();
}

struct SpareStacks {
  SpareStacks() { pages.reserve(kMaxSpare); }
  std::vector<Pages> pages;
};

thread_local SpareStacks spare;

Pages take_stack() {
  if (spare.pages.empty()) return new_stack();
  Pages pages = std::move(spare.pages.back());
  spare.pages.pop_back();
  return pages;
}

}  // namespace

FiberStack::FiberStack() : pages_(take_stack()), bottom_(pages_.data() + page_size()) {}

FiberStack::~FiberStack() {
  if (spare.pages.size() < kMaxSpare) spare.pages.push_back(std::move(pages_));
}

}  // namespace racebeam
