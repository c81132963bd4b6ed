// Memory for large tables that are read at random places: in pages of 2 MiB, where the system has them. Few
// entries of the processor's translation buffer (TLB) then cover a whole table.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

#include "system/pages.hpp"

namespace racebeam {

template <typename T>
class HugePages {  // an allocator
 public:
  using value_type = T;

  HugePages() = default;
  template <typename Other>
  explicit HugePages(const HugePages<Other>&) {}

  T* allocate(std::size_t count) {
    const std::size_t size = rounded(count * sizeof(T));
    void* const memory = ::operator new(size, alignment(size));
    if (size >= kPage) prefer_large_pages(memory, size);
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t count) {
    const std::size_t size = rounded(count * sizeof(T));
    ::operator delete(memory, alignment(size));  // clang 14 has the one with the size only on demand
  }
  bool operator==(const HugePages&) const = default;

 private:
  static constexpr std::size_t kPage = std::size_t{2} << 20;
  static constexpr std::size_t rounded(std::size_t size) {
    return size < kPage ? size : (size + kPage - 1) / kPage * kPage;
  }
  static constexpr std::align_val_t alignment(std::size_t size) {
    return std::align_val_t{size < kPage ? alignof(std::max_align_t) : kPage};
  }
};

template <typename T>
using HugeTable = std::vector<T, HugePages<T>>;

}  // namespace racebeam
