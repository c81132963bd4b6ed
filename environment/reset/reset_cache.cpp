#include "environment/reset/reset_cache.hpp"

#include <algorithm>
#include <cstring>

#include "emulator/state/state_hash.hpp"

namespace racebeam {

std::uint64_t ResetStart::hash() const {
  StateHash hash;
  hash.add(machine);
  hash.add(sound);
  hash.add(std::array{image.get()});
  hash.add(std::array{game.get()});
  hash.add(std::array{limits.min, limits.max, mode, difficulty, static_cast<std::int32_t>(format)});
  return hash.value();
}

bool ResetStart::operator==(const ResetStart& other) const {
  return image == other.image && game == other.game && limits.min == other.limits.min &&
         limits.max == other.limits.max && mode == other.mode && difficulty == other.difficulty &&
         format == other.format && sound == other.sound &&
         std::memcmp(&machine, &other.machine, sizeof machine) == 0;
}

void ResetCache::set_capacity(std::size_t entries) {
  const std::lock_guard lock(mutex_);
  capacity_ = std::max<std::size_t>(entries, 1);
  shrink_to(capacity_);
}

void ResetCache::shrink_to(std::size_t entries) {
  while (entries_.size() > entries) entries_.erase(std::ranges::min_element(entries_, {}, &Entry::used));
}

std::optional<ResetEnd> ResetCache::find(const ResetStart& start) {
  const std::uint64_t hash = start.hash();
  const std::lock_guard lock(mutex_);
  for (Entry& entry : entries_) {
    if (entry.hash != hash || entry.start != start) continue;
    entry.used = ++calls_;
    return entry.end;
  }
  return std::nullopt;
}

void ResetCache::keep(const ResetStart& start, ResetEnd end) {
  const std::uint64_t hash = start.hash();
  for (std::shared_ptr<FrameBuffer>* const picture : {&end.pictures.current, &end.pictures.previous})
    if (*picture) *picture = std::make_shared<FrameBuffer>(**picture, Paging::kUsual);
  const std::lock_guard lock(mutex_);
  shrink_to(capacity_ - 1);
  entries_.push_back({hash, ++calls_, start, std::move(end)});
}

std::size_t ResetCache::size() {
  const std::lock_guard lock(mutex_);
  return entries_.size();
}

ResetCache& reset_cache() {
  static ResetCache cache;
  return cache;
}

}  // namespace racebeam
