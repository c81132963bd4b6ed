// Memory of machines that play in turns, in large pages. A machine's step uses some 200 KiB at places that
// are far apart. In pages of 4 KiB, those of many machines are more than the processor's translation buffers
// (TLB) hold. A machine has too little memory for a large page of its own, so machines share them.
#pragma once

#include <cstddef>
#include <vector>

namespace racebeam {

// While one of these exists for enough machines, MachineVector takes its memory from large pages. The blocks
// may outlive it.
class ManyMachines {
 public:
  explicit ManyMachines(std::size_t machines);
  ~ManyMachines();
  ManyMachines(const ManyMachines&) = delete;
  ManyMachines& operator=(const ManyMachines&) = delete;

 private:
  const int counted_;  // 1, or 0 for few machines
};

// Large pages that hold a block.
std::size_t large_pages_in_use();

// Usual paging is for what may outlive a vector of machines, and would keep a whole large page.
enum class Paging { kLarge, kUsual };

void* take_machine_memory(std::size_t size, Paging paging);  // aligned to 64 bytes; or std::bad_alloc
void give_back_machine_memory(void* memory) noexcept;

template <typename T>
class MachineAllocator {
 public:
  using value_type = T;

  explicit(false) MachineAllocator(Paging paging = Paging::kLarge) : paging_(paging) {}
  template <typename Other>
  explicit MachineAllocator(const MachineAllocator<Other>& other) : paging_(other.paging()) {}

  T* allocate(std::size_t count) { return static_cast<T*>(take_machine_memory(count * sizeof(T), paging_)); }
  void deallocate(T* memory, std::size_t) noexcept { give_back_machine_memory(memory); }
  Paging paging() const { return paging_; }
  bool operator==(const MachineAllocator&) const { return true; }  // each gives back the memory of the other

 private:
  Paging paging_;
};

template <typename T>
using MachineVector = std::vector<T, MachineAllocator<T>>;

}  // namespace racebeam
