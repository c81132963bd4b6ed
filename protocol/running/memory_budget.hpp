// A limit for the memory of all sessions together. Sessions count what they hold from the sizes of their
// buffers, not from the allocator. A budget has parts: the server's has one for each client, and a client's
// has one for each session. When memory is short, the server finds with them who holds much.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

namespace racebeam {

// Thread-safe.
class MemoryBudget {
 public:
  static constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();

  explicit MemoryBudget(std::uint64_t most = kNoLimit) : most_(most) {}
  explicit MemoryBudget(std::shared_ptr<MemoryBudget> whole);  // a part: what it takes is taken of `whole`
  ~MemoryBudget();
  MemoryBudget(const MemoryBudget&) = delete;
  MemoryBudget& operator=(const MemoryBudget&) = delete;

  // The part of `whole` with this name; it exists as long as somebody holds it.
  static std::shared_ptr<MemoryBudget> part(const std::shared_ptr<MemoryBudget>& whole,
                                            const std::string& name);

  // Returns false, and takes nothing, if less is left, or less than `spare` would remain.
  bool take(std::uint64_t bytes, std::uint64_t spare = 0);
  void take_anyway(std::uint64_t bytes);  // for memory that is allocated already
  bool has(std::uint64_t bytes) const { return all().taken_ <= most_ && bytes <= most_ - all().taken_; }
  void give_back(std::uint64_t bytes);

  std::uint64_t taken() const { return taken_; }  // by this part
  std::uint64_t most() const { return most_; }    // of all parts together
  std::size_t parts() const { return parts_; }
  const MemoryBudget* whole() const { return whole_.get(); }                  // null: this is not a part
  const MemoryBudget& all() const { return whole_ ? whole_->all() : *this; }  // the root of all parts

  // The last eighth is reserved for sessions that hold little. Small requests and new sessions thus have room
  // although large ones have all that they can get.
  std::uint64_t reserve() const { return most_ / 8; }
  std::uint64_t little() const { return std::max(most_ / 512, kLeastLittle); }
  // An owner that holds more than half of the memory does not get the last thirty-second, which is left for
  // clients of other owners. This is whether the part is such an owner's.
  bool crowds_others_out() const { return whole_ && whole_->parts_ > 1 && taken_ > most_ / 2; }
  std::uint64_t reserve_for_other_owners() const { return most_ / 32; }
  // How much is taken of the last sixteenth. Sessions then keep nothing that they can recreate, and the
  // server ends some.
  std::uint64_t shortage() const;
  bool is_short() const { return shortage() > 0; }

 private:
  static constexpr std::uint64_t kLeastLittle = 1 << 20;

  const std::shared_ptr<MemoryBudget> whole_;
  const std::uint64_t most_;
  std::atomic<std::uint64_t> taken_ = 0;
  std::atomic<std::size_t> parts_ = 0;
  std::mutex mutex_;
  std::map<std::string, std::weak_ptr<MemoryBudget>> named_;
};

// The part of a budget that one owner has taken; its destructor returns it.
class MemoryShare {
 public:
  explicit MemoryShare(std::shared_ptr<MemoryBudget> budget)  // null: unlimited
      : budget_(std::move(budget)) {}
  ~MemoryShare() { set(0); }
  MemoryShare(const MemoryShare&) = delete;
  MemoryShare& operator=(const MemoryShare&) = delete;

  void set(std::size_t bytes);  // what the owner holds
  // Returns false, and takes nothing, if less is left for an owner of this size.
  bool grow(std::size_t bytes);
  void check(std::size_t bytes, const std::string& what);  // as grow(), but throws RequestError
  bool is_short() const { return budget_ != nullptr && budget_->is_short(); }

  std::size_t bytes() const { return bytes_; }

 private:
  std::uint64_t spare_after(std::size_t bytes) const;

  const std::shared_ptr<MemoryBudget> budget_;
  std::size_t bytes_ = 0;
};

}  // namespace racebeam
