#include "protocol/line/share.hpp"

#include <algorithm>
#include <utility>

namespace racebeam {

using namespace std::chrono_literals;

// Watchers see these, so they are not rows of a tuning table: protocol/PROTOCOL.md promises at most 60 copies
// a second, and `fps` is the mean of half a second or more.
constexpr auto kBetweenCopies = 1'000'000us / 60;
constexpr auto kBetweenCounts = 500ms;  // of frames, for fps

std::shared_ptr<const Snapshot> Share::newest() {
  wants_copies_.store(true, std::memory_order_relaxed);
  const std::lock_guard lock(mutex_);
  return newest_;
}

std::unique_ptr<Share::Place> Share::place(const std::shared_ptr<Share>& share) {
  auto place = std::make_unique<Place>(share);  // its end gives back what the next line takes
  if (share->watchers_++ < share->most_watchers_) return place;
  return nullptr;
}

void Share::publish(Snapshot snapshot, std::int64_t frames) {
  const auto now = Snapshot::Clock::now();
  const std::chrono::duration<double> past = now - counted_;
  if (past > kBetweenCounts) {
    if (counted_ != Snapshot::Clock::time_point()) {
      fps_ = static_cast<double>(frames - counted_frames_) / past.count();
    }
    counted_ = now;
    counted_frames_ = frames;
  }
  snapshot.fps = fps_;
  snapshot.when = now;
  next_ = now + kBetweenCopies;
  wants_copies_.store(false, std::memory_order_relaxed);
  auto newest = std::make_shared<const Snapshot>(std::move(snapshot));
  const std::lock_guard lock(mutex_);
  newest_.swap(newest);
}

bool Shares::add(const std::shared_ptr<Share>& share, const Share* replaced) {
  const std::lock_guard lock(mutex_);
  const auto [place, is_new] = by_name_.try_emplace(share->name(), share);
  if (!is_new && place->second.get() != replaced) return false;
  place->second = share;
  return true;
}

void Shares::remove(const Share& share) {
  const std::lock_guard lock(mutex_);
  const auto found = by_name_.find(share.name());
  if (found != by_name_.end() && found->second.get() == &share) by_name_.erase(found);
}

std::string Shares::next_name() {
  const std::lock_guard lock(mutex_);
  return "session-" + std::to_string(++named_);
}

std::shared_ptr<Share> Shares::find(std::string_view name) const {
  const std::lock_guard lock(mutex_);
  const auto found = by_name_.find(name);
  return found == by_name_.end() ? nullptr : found->second;
}

std::vector<std::shared_ptr<Share>> Shares::all() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::shared_ptr<Share>> shares;
  for (const auto& [name, share] : by_name_) shares.push_back(share);
  return shares;
}

// Everything is allocated before the name is taken, so that a failure leaves it free.
std::unique_ptr<Sharing> Sharing::open(const std::shared_ptr<Shares>& all, const std::string& name,
                                       int most_watchers, const Sharing* replaced) {
  auto sharing = std::make_unique<Sharing>(all, std::make_shared<Share>(name, most_watchers));
  return all->add(sharing->share_, replaced ? replaced->share_.get() : nullptr) ? std::move(sharing)
                                                                                : nullptr;
}

std::unique_ptr<Sharing> Sharing::open_next(const std::shared_ptr<Shares>& all, int most_watchers) {
  std::unique_ptr<Sharing> sharing;
  while (!sharing) sharing = open(all, all->next_name(), most_watchers);
  return sharing;
}

}  // namespace racebeam
