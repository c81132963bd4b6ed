// A session of the classic protocol with its machine, whose work is done in slices by the clock.
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
#include "protocol/running/memory_budget.hpp"
#include "protocol/running/pacer.hpp"

namespace racebeam {

struct ClassicService {
  std::function<Environment(Pace* pace)>
      power_on;  // a machine of its own for each session; called from any thread
  ClassicOptions options;
  std::shared_ptr<MemoryBudget> memory;  // of all sessions; null: there is no limit
};

class PacedClassic {
 public:
  explicit PacedClassic(const ClassicService& service);  // outlives the session
  ~PacedClassic();
  PacedClassic(const PacedClassic&) = delete;
  PacedClassic& operator=(const PacedClassic&) = delete;

  // Powers the machine on and works on the next reply, for about as long as `slice`. Returns true when
  // reply() has something to tell.
  bool work(std::chrono::microseconds slice = std::chrono::microseconds(2000));
  std::chrono::steady_clock::duration worked() const { return worked_; }  // how long that took

  // Once work() has returned true: the text to be sent, good until work() is called again, or nothing if
  // input is needed first. Throws ClassicError, and InvalidInput when the machine cannot be had.
  std::optional<std::string_view> reply();
  void check_machine() const;  // throws as reply(), which still has the same to tell
  bool ended() const { return session_ && session_->ended(); }

  std::span<char> space() { return session_->space(); }  // where input goes
  void received(std::size_t count) { session_->received(count); }
  int take_frames() { return session_ ? session_->take_frames() : 0; }
  const Environment& machine() const { return *machine_; }  // after check_machine()
  void rest() {  // nothing has come for a while: memory is given back that only saves time
    if (machine_) machine_->rest();
  }

 private:
  void answer();
  void account();

  const ClassicService& service_;
  MemoryShare memory_;
  std::optional<Environment> machine_;  // powered on by the first slices
  std::optional<ClassicSession> session_;
  bool is_ready_ = false;  // reply() has something to tell
  std::optional<std::string_view> reply_;
  std::exception_ptr failure_;
  std::chrono::steady_clock::duration worked_{};
  Pacer pacer_;
};

}  // namespace racebeam
