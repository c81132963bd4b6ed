// Sessions that others may watch. A session never waits for its watchers: it publishes a copy of what its
// machine shows, if one of them has asked since the last copy.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "environment/vector/slot.hpp"

namespace racebeam {

constexpr int kUsualWatchers = 1000;  // of a shared session at the same time

// What a shared session showed after one of its requests.
struct Snapshot {
  using Clock = std::chrono::steady_clock;

  std::string game;
  Format format;
  std::int64_t frame = 0;    // since power-on
  std::int64_t episode = 0;  // of the session, from 1
  std::int64_t score = 0;    // of the episode
  std::int64_t reward = 0;   // of the request
  int lives = 0;
  int action = 0;     // of player A, the last one
  bool over = false;  // the episode
  double fps = 0;     // frames a second that the session ran lately
  Clock::time_point when;
  std::vector<std::uint8_t> screen;
  std::array<std::uint8_t, kRamSize> ram;

  int height() const { return static_cast<int>(screen.size()) / kScreenWidth; }
};

// One shared session.
class Share {
 public:
  Share(std::string name, int most_watchers) : name_(std::move(name)), most_watchers_(most_watchers) {}

  const std::string& name() const { return name_; }
  int most_watchers() const { return most_watchers_; }

  // For watchers. Thread-safe. Null before the first copy; the session then publishes a newer one.
  std::shared_ptr<const Snapshot> newest();
  bool ended() const { return ended_; }

  // A watcher's place, as long as it lives.
  class Place {
   public:
    explicit Place(std::shared_ptr<Share> share) : share_(std::move(share)) {}
    ~Place() { --share_->watchers_; }
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;
    Share& share() const { return *share_; }

   private:
    const std::shared_ptr<Share> share_;
  };
  // Null if the number of watchers has reached its limit. Thread-safe.
  static std::unique_ptr<Place> place(const std::shared_ptr<Share>& share);

  // For the session, on its thread.
  bool is_wanted() const { return wants_copies_.load(std::memory_order_relaxed); }
  // Whether the last copy is older than the shortest time between two: a sixtieth of a second.
  bool is_due(Snapshot::Clock::time_point now) const { return now >= next_; }
  void publish(Snapshot snapshot, std::int64_t frames);  // frames: that the session has run in all
  void end() { ended_ = true; }

 private:
  const std::string name_;
  const int most_watchers_;
  std::atomic<bool> wants_copies_ = true, ended_ = false;
  std::atomic<int> watchers_ = 0;

  // The session's thread uses these:
  Snapshot::Clock::time_point next_{}, counted_{};  // counted_: when fps was last computed
  std::int64_t counted_frames_ = 0;
  double fps_ = 0;

  std::mutex mutex_;
  std::shared_ptr<const Snapshot> newest_;
};

// The shared sessions of a server, by name. Thread-safe.
class Shares {
 public:
  // False: its name is taken by another share than `replaced`.
  bool add(const std::shared_ptr<Share>& share, const Share* replaced = nullptr);
  void remove(const Share& share);  // if it is there
  std::string next_name();          // session-1, session-2 and so on

  std::shared_ptr<Share> find(std::string_view name) const;  // null: unknown
  std::vector<std::shared_ptr<Share>> all() const;

 private:
  mutable std::mutex mutex_;
  std::map<std::string, std::shared_ptr<Share>, std::less<>> by_name_;
  std::int64_t named_ = 0;  // by next_name()
};

// A session's share, which ends with it.
class Sharing {
 public:
  // Null if the name is taken. It may be that of the session's own share, `replaced`, which then has no name.
  static std::unique_ptr<Sharing> open(const std::shared_ptr<Shares>& all, const std::string& name,
                                       int most_watchers, const Sharing* replaced = nullptr);
  // Under the next name that is free.
  static std::unique_ptr<Sharing> open_next(const std::shared_ptr<Shares>& all, int most_watchers);
  Sharing(std::shared_ptr<Shares> all, std::shared_ptr<Share> share)
      : all_(std::move(all)), share_(std::move(share)) {}
  ~Sharing() {
    share_->end();
    all_->remove(*share_);
  }
  Sharing(const Sharing&) = delete;
  Sharing& operator=(const Sharing&) = delete;

  Share& share() const { return *share_; }

 private:
  const std::shared_ptr<Shares> all_;
  const std::shared_ptr<Share> share_;
};

}  // namespace racebeam
