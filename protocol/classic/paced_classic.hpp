// A session of the classic protocol with its machine. Its work is divided into slices of time.
#pragma once

#include <chrono>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "environment/environment.hpp"
#include "protocol/classic/classic.hpp"
#include "protocol/running/disposal.hpp"
#include "protocol/running/memory_budget.hpp"
#include "protocol/running/pacer.hpp"

namespace racebeam {

struct ClassicService {
  std::function<Environment(Pace* pace)> power_on;  // makes a machine for each session; thread-safe
  ClassicOptions options;
  std::shared_ptr<MemoryBudget> memory;          // of all sessions; null: unlimited
  std::shared_ptr<Disposal> disposal = nullptr;  // of ended sessions; null: they are destroyed at once
};

class PacedClassic {
 public:
  // `service` must outlive the session. memory: its budget; null: the service's.
  explicit PacedClassic(const ClassicService& service, const std::shared_ptr<MemoryBudget>& memory = nullptr);
  ~PacedClassic();
  PacedClassic(const PacedClassic&) = delete;
  PacedClassic& operator=(const PacedClassic&) = delete;

  // Powers the machine on, and works on the next reply, for about `slice`. Returns true when reply() has a
  // result.
  bool work(std::chrono::microseconds slice = std::chrono::microseconds(2000));
  std::chrono::steady_clock::duration worked() const { return worked_; }  // duration of the last work()

  // After work() has returned true: the text to send, or nothing if input is needed first. The text is valid
  // until the next work(). Throws ClassicError, and InvalidInput if the machine could not be powered on.
  std::optional<std::string_view> reply();
  void check_machine() const;  // throws as reply(), without consuming its result
  bool ended() const { return session_ && session_->ended(); }

  std::span<char> space() { return session_->space(); }  // where input goes
  void received(std::size_t count) { session_->received(count); }
  int take_frames() { return session_ ? session_->take_frames() : 0; }
  const Environment& machine() const { return *machine_; }  // after check_machine()
  void release_caches();                                    // called when no request has come for a while
  void leave() { pacer_.cancel(); }  // the destructor, on any thread, only frees memory then
  std::size_t bytes() const { return memory_.bytes(); }

 private:
  void answer();
  void account();
  std::size_t footprint() const;

  const ClassicService& service_;
  MemoryShare memory_;
  std::optional<Environment> machine_;  // powered on by the first slices
  std::optional<ClassicSession> session_;
  bool caches_released_ = false;  // the machine has released its caches
  bool is_ready_ = false;         // reply() has a result
  std::optional<std::string_view> reply_;
  std::exception_ptr failure_;
  std::chrono::steady_clock::duration worked_{};
  Pacer pacer_;
};

}  // namespace racebeam
