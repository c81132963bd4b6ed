// Memory of machines that play in turns, in large pages. A machine's step uses some 200 KiB at places that
// are far apart. In pages of 4 KiB, those of many machines are more than the processor's translation buffers
// (TLB) hold. A machine has too little memory for a large page of its own, so machines share them.
#pragma once

#include <cstddef>
#include <vector>

namespace racebeam {

// While an object for enough machines exists, MachineVector allocates from large pages. Its blocks may
// outlive the object. Thread-safe, as are the functions below.
class LargePageScope {
 public:
  explicit LargePageScope(std::size_t machines);
  ~LargePageScope();
  LargePageScope(const LargePageScope&) = delete;
  LargePageScope& operator=(const LargePageScope&) = delete;

 private:
  const int counted_;  // 1: large pages are in use for it; 0: it has too few machines
};

// The number of large pages that hold at least one block.
std::size_t large_pages_in_use();

// kUsual is for memory that may outlive a vector of machines: a block in a large page keeps that whole page.
enum class Paging { kLarge, kUsual };

void* allocate_machine_memory(std::size_t size, Paging paging);  // aligned to 64 bytes; or std::bad_alloc
void free_machine_memory(void* memory) noexcept;

template <typename T>
class MachineAllocator {
 public:
  using value_type = T;

  explicit(false) MachineAllocator(Paging paging = Paging::kLarge) : paging_(paging) {}
  template <typename Other>
  explicit MachineAllocator(const MachineAllocator<Other>& other) : paging_(other.paging()) {}

  T* allocate(std::size_t count) {
    return static_cast<T*>(allocate_machine_memory(count * sizeof(T), paging_));
  }
  void deallocate(T* memory, std::size_t) noexcept { free_machine_memory(memory); }
  Paging paging() const { return paging_; }
  bool operator==(const MachineAllocator&) const { return true; }  // each gives back the memory of the other

 private:
  Paging paging_;
};

template <typename T>
using MachineVector = std::vector<T, MachineAllocator<T>>;

}  // namespace racebeam
