#include "emulator/base/large_pages.hpp"

#include <array>
#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <system_error>
#include <utility>

#include "system/forks.hpp"
#include "system/pages.hpp"

namespace racebeam {
namespace {

constexpr std::size_t kFewestMachines = 8;  // four gain nothing (docs/performance/history.md)
constexpr std::size_t kPage = std::size_t{2} << 20;
constexpr std::size_t kLargestBlock = kPage / 2;
constexpr std::size_t kAlignment = 64;

std::atomic<int> vectors_of_many = 0;
std::atomic<std::size_t> pages_in_use = 0;

struct Page;

// Precedes each block.
struct alignas(kAlignment) Header {
  Page* page;  // null: the block is in no large page
  std::size_t size;
  Header* next = nullptr;  // of a free block: the next free one of its size
};

struct alignas(kAlignment) Page {
  explicit Page(Pages from) : mapping(std::move(from)) {}

  Pages mapping;           // the mapping that contains the page
  std::size_t blocks = 0;  // in use
  std::size_t used = 0;    // bytes of `memory` that were given out
  alignas(kAlignment) std::array<std::byte, kPage - kAlignment> memory;
};
static_assert(sizeof(Page) == kPage);

std::size_t size_with_header(std::size_t size) {
  return sizeof(Header) + (size + kAlignment - 1) / kAlignment * kAlignment;
}

// An allocator with free lists, one for each size: the machines of a vector need blocks of the same sizes.
class LargePages {
 public:
  // `size` includes the header.
  Header* take(std::size_t size) {
    const std::lock_guard guard(lock_);
    Header*& free = free_[size];
    Header* const header = free != nullptr ? std::exchange(free, free->next) : new_block(size);
    ++header->page->blocks;
    return header;
  }

  void give_back(Header* header) {
    const std::lock_guard guard(lock_);
    Page* const page = header->page;
    header->next = std::exchange(free_[header->size], header);
    if (--page->blocks == 0) release(page);
  }

 private:
  Header* new_block(std::size_t size) {
    if (newest_ == nullptr || newest_->memory.size() - newest_->used < size) newest_ = new_page();
    std::byte* const place = &newest_->memory[newest_->used];
    newest_->used += size;
    return new (place) Header{newest_, size};
  }

  // A mapping of twice the size contains an aligned page. The rest takes no memory, since it is never
  // touched.
  static Page* new_page() {
    Pages mapping = map(2 * kPage);
    void* memory = mapping.data();
    std::size_t size = mapping.size();
    std::align(kPage, kPage, memory, size);
    prefer_large_pages(memory, kPage);
    ++pages_in_use;
    return new (memory) Page(std::move(mapping));
  }

  static Pages map(std::size_t size) try { return Pages(size); } catch (const std::system_error&) {
    throw std::bad_alloc();
  }

  void release(Page* page) {
    for (auto& [size, first] : free_)
      for (Header** at = &first; *at != nullptr;) {
        if ((*at)->page == page)
          *at = (*at)->next;
        else
          at = &(*at)->next;
      }
    if (newest_ == page) newest_ = nullptr;
    const Pages unmapped_at_the_end = std::move(page->mapping);
    --pages_in_use;
  }

  std::mutex lock_;
  Page* newest_ = nullptr;
  std::map<std::size_t, Header*> free_;  // the first free block of each size
};

// Never destroyed, since blocks may be given back while the process ends. A copy of the process begins with
// new lists: another thread may have held the lock.
LargePages* large_pages = new LargePages;
[[maybe_unused]] const bool forks_begin_anew =
    (call_in_forked_children([] { large_pages = new LargePages; }), true);

}  // namespace

LargePageScope::LargePageScope(std::size_t machines)
    : counted_(can_prefer_large_pages() && machines >= kFewestMachines ? 1 : 0) {
  vectors_of_many += counted_;
}
LargePageScope::~LargePageScope() { vectors_of_many -= counted_; }

std::size_t large_pages_in_use() { return pages_in_use; }

void* allocate_machine_memory(std::size_t size, Paging paging) {
  const std::size_t all = size_with_header(size);
  if (paging == Paging::kLarge && all <= kLargestBlock && vectors_of_many > 0)
    return large_pages->take(all) + 1;
  return new (::operator new (all, std::align_val_t{kAlignment})) Header{nullptr, all} + 1;
}

void free_machine_memory(void* memory) noexcept {
  Header* const header = static_cast<Header*>(memory) - 1;
  if (header->page == nullptr) return ::operator delete (header, std::align_val_t{kAlignment});
  large_pages->give_back(header);
}

}  // namespace racebeam
