// Schedules the sessions of an event loop. A session that has used the loop much lately waits for sessions
// with short requests, and then for those that have used it less.
#pragma once

#include <utility>  // needed by Asio 1.74
#include <vector>

#include <boost/asio/awaitable.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>

#include "server/scheduling/usage.hpp"

namespace racebeam {

class Turns {
 public:
  using Clock = Usage::Clock;

  // Whether a session may work at once: because it is its turn, it is alone on the loop, or its request is
  // short.
  bool may_work(const Usage& usage) const {
    if (next_ == &usage) return true;
    if (last_ == &usage && waiting_.empty()) return true;
    return usage.lately(Clock::now()) < kBrief;
  }

  void worked(Usage& usage, Clock::duration time) {
    usage.add(time, Clock::now());
    last_ = &usage;
    next_ = nullptr;
  }

  // Returns when it is the session's turn. Meanwhile, the loop handles other events.
  boost::asio::awaitable<void> wait(const Usage& usage);

  bool empty() const { return waiting_.empty(); }
  void wake_next();  // the session that has used the loop least; there must be one

 private:
  static constexpr double kBrief = 0.001;  // seconds of recent use

  struct Waiting {
    const Usage* usage;
    boost::asio::steady_timer* timer;
  };

  std::vector<Waiting> waiting_;
  const Usage* last_ = nullptr;  // the session that worked last
  const Usage* next_ = nullptr;  // whose turn it is; null: no session's
};

}  // namespace racebeam
