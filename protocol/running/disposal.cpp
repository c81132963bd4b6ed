#include "protocol/running/disposal.hpp"

#include <algorithm>
#include <cstdint>
#include <system_error>

#include "system/pages.hpp"

namespace racebeam {

Disposal::Disposal() {
  try {
    thread_ = std::thread([this] { run(); });
  } catch (const std::system_error&) {
    // Objects are destroyed at once.
  }
}

Disposal::~Disposal() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  changed_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void Disposal::take(std::shared_ptr<void> object) {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    objects_.push_back(std::move(object));
  }
  changed_.notify_one();
}

void Disposal::run() {
  std::vector<std::shared_ptr<void>> objects;
  for (std::unique_lock lock(mutex_);;) {
    changed_.wait(lock, [this] { return ends_ || !objects_.empty(); });
    if (objects_.empty()) return;
    objects.swap(objects_);
    lock.unlock();
    objects.clear();
    lock.lock();
  }
}

void release_pages(std::string& text) {
  constexpr std::size_t kPiece = std::size_t{1} << 20;
  if (text.capacity() < 4 * kPiece) return;
  const std::size_t page = page_size();
  const std::size_t first = (page - reinterpret_cast<std::uintptr_t>(text.data()) % page) % page;
  const std::size_t end = first + (text.capacity() - first) / page * page;
  for (std::size_t at = first; at < end; at += kPiece)
    discard_pages(text.data() + at, std::min(kPiece, end - at));
}

}  // namespace racebeam
