// Shares an event loop out: a session that has used the loop much lately waits until the sessions that ask
// briefly have been served, and then for those that have used it less.
#pragma once

#include <utility>  // Asio 1.74 forgets it
#include <vector>

#include <boost/asio/awaitable.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>

#include "server/scheduling/usage.hpp"

namespace racebeam {

class Turns {
 public:
  using Clock = Usage::Clock;

  // Whether a session may work at once: when it is its turn, when it has the loop to itself, and when it asks
  // briefly.
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

  // Returns when it is the session's turn. In between, the loop handles what else is ready.
  boost::asio::awaitable<void> wait(const Usage& usage);

  bool empty() const { return waiting_.empty(); }
  void wake_next();  // the one that has used the loop least; there is one

 private:
  static constexpr double kBrief = 0.001;  // seconds lately

  struct Waiting {
    const Usage* usage;
    boost::asio::steady_timer* timer;
  };

  std::vector<Waiting> waiting_;
  const Usage* last_ = nullptr;  // that has worked
  const Usage* next_ = nullptr;  // whose turn it is; null: there is none
};

}  // namespace racebeam
