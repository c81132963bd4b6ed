// Divides the work of a session, or of one machine among many, into slices of time, and counts its frames.
#pragma once

#include <chrono>
#include <cstdint>
#include <limits>
#include <utility>

#include "emulator/pace.hpp"
#include "protocol/running/fiber.hpp"
#include "protocol/tuning.hpp"

namespace racebeam {

class Pacer final : public Pace {
 public:
  using Clock = std::chrono::steady_clock;

  // Works until `end`, or a few frames longer: calls `body`, or continues the one in progress. Returns true
  // when the body has returned. Throws what the body throws, and std::bad_alloc if memory does not suffice
  // to begin.
  template <typename Body>
  bool work(Clock::time_point end, Body body) {
    end_ = end;
    return in_progress() ? fiber_.resume() : fiber_.start(std::move(body));
  }
  bool resume(Clock::time_point end) {
    end_ = end;
    return fiber_.resume();
  }

  bool in_progress() const { return fiber_.in_progress(); }
  void cancel() { fiber_.cancel(); }  // unwinds the body

  // What follows is for the body.

  Clock::time_point end() const { return end_; }  // of the slice

  void frame() override {
    count(1);
    if (--frames_before_look_ <= 0) check_clock();
  }

  // Suspends the body if its slice is over: for loops that take long without running frames.
  void yield_if_due() {
    if (Clock::now() >= end_) pause();
  }

  // Suspends the body.
  void pause() {
    if (in_progress()) fiber_.suspend();
  }

  // Frames that other threads have run for this body. Throws RequestError when there are more than
  // allow_frames() said.
  void count(std::int64_t frames) {
    frames_ += frames;
    if (frames_ > most_frames_) refuse();
  }
  std::int64_t frames() const override { return frames_; }  // counted so far, of all bodies

  void allow_frames(std::int64_t more);  // from now on
  void allow_any_frames() { most_frames_ = kNoLimit; }

 private:
  static constexpr std::int64_t kNoLimit = std::numeric_limits<std::int64_t>::max();

  void check_clock() {
    const auto now = Clock::now();
    frames_before_look_ = now - looked_ < tuning::kLongBetweenLooks ? tuning::kFramesBetweenLooks : 1;
    looked_ = now;
    if (now >= end_) pause();
  }
  [[noreturn]] void refuse() const;

  Fiber fiber_;
  Clock::time_point end_{}, looked_{};
  int frames_before_look_ = tuning::kFramesBetweenLooks;
  std::int64_t frames_ = 0, most_frames_ = kNoLimit, allowed_ = 0;
};

}  // namespace racebeam
