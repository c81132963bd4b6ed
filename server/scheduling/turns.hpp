// Schedules the sessions of an event loop by start-time fair queueing (Goyal, Vin and Cheng, 1996).
//
// The usage of a session is the time for which it has worked. While sessions wait, the one with the least
// usage is next, so each gets an equal share of the loop. A session that comes back after a pause is treated
// as if it had worked until now, less a credit. A short request therefore comes before the next slice of a
// long one.
#pragma once

#include <algorithm>
#include <chrono>
#include <map>
#include <utility>  // needed by Asio 1.74

#include <boost/asio/io_context.hpp>

#include "server/scheduling/task.hpp"
#include "server/tuning.hpp"

namespace racebeam {

// How long a session has worked, on the clock of its loop.
using Usage = std::chrono::steady_clock::duration;

class Turns {
 public:
  using Duration = std::chrono::steady_clock::duration;

  // Whether a session that wants to work may do so at once. Otherwise it waits for its turn.
  bool may_work(Usage& usage) const {
    usage = std::max(usage, now_ - tuning::kCreditOfPause);
    return worked_ < tuning::kLongestSlice && (waiting_.empty() || usage <= waiting_.begin()->first);
  }

  // Returns when it is the session's turn to work for one slice. Meanwhile, `loop` handles other events.
  Task<> wait(boost::asio::io_context& loop, Usage usage);

  // For how long a session works before it asks for another turn. If many sessions wait, slices are short,
  // since each session waits for the slices of all others.
  std::chrono::microseconds slice() const;

  // A slice lasts longer if another program takes the processor away. Not all of that time is charged to the
  // session, which would otherwise wait until each other session had worked for as long.
  void worked(Usage& usage, Duration time) {
    now_ = std::max(now_, usage);
    usage += std::min<Duration>(time, tuning::kMostCharged * slice()) + tuning::kCostOfSlice;
    worked_ += time;
  }

  Duration worked() const { return worked_; }  // by all sessions, since the last turn

  bool empty() const { return waiting_.empty(); }
  void wake_next();  // there must be a session that waits

 private:
  class Place;
  using Waiting = std::multimap<Usage, Place*>;

  Waiting waiting_;
  Usage now_{};  // usage of the session that worked last, at the start of its slice
  Duration worked_{};
};

}  // namespace racebeam
