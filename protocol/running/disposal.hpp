// Destroys large objects on its own thread. Returning a MiB to the system takes about 0.3 ms, for which the
// other sessions of a loop would wait.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <memory>
#include <mutex>
#include <new>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "protocol/running/memory_budget.hpp"

namespace racebeam {

class Disposal {
 public:
  static constexpr std::size_t kWorthwhile = std::size_t{1} << 20;  // bytes; less is destroyed at once

  Disposal();
  ~Disposal();  // destroys what is left
  Disposal(const Disposal&) = delete;
  Disposal& operator=(const Disposal&) = delete;

  // Thread-safe. Destroys the object at once if the system provided no thread.
  void take(std::shared_ptr<void> object);

 private:
  void run();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::shared_ptr<void>> objects_;
  bool ends_ = false;
  std::thread thread_;
};

// Destroys `object`, by `disposal` if that is not null and the object's `bytes` are worth it. They count in
// `memory`, which may be null, until then.
template <typename T>
void dispose(const std::shared_ptr<Disposal>& disposal, const std::shared_ptr<MemoryBudget>& memory,
             std::size_t bytes, T object) noexcept {
  if (disposal == nullptr || bytes < Disposal::kWorthwhile) return;
  struct Remains {
    Remains(const std::shared_ptr<MemoryBudget>& budget, T rest) : counted(budget), object(std::move(rest)) {}
    MemoryShare counted;
    T object;
  };
  try {
    auto remains = std::make_shared<Remains>(memory, std::move(object));
    remains->counted.set(bytes);
    disposal->take(std::move(remains));
  } catch (const std::bad_alloc&) {
    // The object is destroyed here.
  }
}

// Releases the pages of a long text, whose content is lost, in pieces: threads that map memory meanwhile wait
// for one piece at most.
void release_pages(std::string& text);

// A text that releases its pages before it is destroyed.
class LongText {
 public:
  explicit LongText(std::string text) : text_(std::move(text)) {}
  ~LongText() { release_pages(text_); }
  LongText(LongText&&) = default;
  LongText& operator=(LongText&&) = delete;

 private:
  std::string text_;
};

}  // namespace racebeam
