#include "protocol/running/fiber_stack.hpp"

#include <sys/mman.h>

#include <new>
#include <vector>

namespace racebeam {
namespace {

constexpr std::size_t kGuard = 4096;
constexpr std::size_t kMostSpare = 4;  // of a thread; a session in progress holds one

std::byte* map_stack() {
  void* const memory = ::mmap(nullptr, kGuard + FiberStack::kBytes, PROT_READ | PROT_WRITE,
                              MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  if (::mprotect(memory, kGuard, PROT_NONE) != 0) {
    ::munmap(memory, kGuard + FiberStack::kBytes);
    throw std::bad_alloc();
  }
  return static_cast<std::byte*>(memory) + kGuard;
}

void unmap_stack(std::byte* bottom) { ::munmap(bottom - kGuard, kGuard + FiberStack::kBytes); }

struct SpareStacks {
  SpareStacks() { bottoms.reserve(kMostSpare); }
  ~SpareStacks() {
    for (std::byte* const bottom : bottoms) unmap_stack(bottom);
  }
  std::vector<std::byte*> bottoms;
};

thread_local SpareStacks spare;

}  // namespace

FiberStack::FiberStack() {
  if (spare.bottoms.empty()) {
    bottom_ = map_stack();
  } else {
    bottom_ = spare.bottoms.back();
    spare.bottoms.pop_back();
  }
}

FiberStack::~FiberStack() {
  if (spare.bottoms.size() < kMostSpare) {
    spare.bottoms.push_back(bottom_);
  } else {
    unmap_stack(bottom_);
  }
}

}  // namespace racebeam
