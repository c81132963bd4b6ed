// A limit for the memory of all sessions together. Memory is estimated, generously; the allocator is not
// asked.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <utility>

namespace racebeam {

// Shared by the sessions of a server. Thread-safe.
class MemoryBudget {
 public:
  static constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();

  explicit MemoryBudget(std::uint64_t most = kNoLimit) : most_(most) {}

  bool take(std::uint64_t bytes);         // returns false, and takes nothing, if less is left
  void take_anyway(std::uint64_t bytes);  // for memory that is allocated already
  bool has(std::uint64_t bytes) const { return taken_ <= most_ && bytes <= most_ - taken_; }
  void give_back(std::uint64_t bytes) { taken_ -= bytes; }

  std::uint64_t taken() const { return taken_; }
  std::uint64_t most() const { return most_; }

 private:
  const std::uint64_t most_;
  std::atomic<std::uint64_t> taken_ = 0;
};

// The part of a budget that one owner has taken; its destructor returns it.
class MemoryShare {
 public:
  explicit MemoryShare(std::shared_ptr<MemoryBudget> budget)  // null: there is no limit
      : budget_(std::move(budget)) {}
  ~MemoryShare() { set(0); }
  MemoryShare(const MemoryShare&) = delete;
  MemoryShare& operator=(const MemoryShare&) = delete;

  void set(std::size_t bytes);   // what the owner holds
  bool grow(std::size_t bytes);  // returns false, and takes nothing, if less is left
  void check(std::size_t bytes, const std::string& what);  // as grow(), but throws RequestError

  std::size_t bytes() const { return bytes_; }

 private:
  const std::shared_ptr<MemoryBudget> budget_;
  std::size_t bytes_ = 0;
};

}  // namespace racebeam
