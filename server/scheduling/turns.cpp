#include "server/scheduling/turns.hpp"

#include <algorithm>
#include <utility>

#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>

namespace racebeam {

namespace net = boost::asio;

// A session's place among those that wait. Its timer never expires, but is cancelled to wake the session.
class Turns::Place {
 public:
  Place(Waiting& all, Usage usage, net::io_context& loop)
      : timer_(loop, net::steady_timer::time_point::max()), all_(all), at_(all.emplace(usage, this)) {}
  ~Place() { leave(); }
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;

  Task<> wait() {
    boost::system::error_code cancelled;
    co_await timer_.async_wait(net::redirect_error(use_task, cancelled));
  }

  // Leaves at once, since the session only runs later.
  void wake() {
    leave();
    timer_.cancel();
  }

 private:
  void leave() {
    if (at_ != all_.end()) all_.erase(std::exchange(at_, all_.end()));
  }

  net::steady_timer timer_;
  Waiting& all_;
  Waiting::iterator at_;
};

Task<> Turns::wait(net::io_context& loop, Usage usage) {
  Place place(waiting_, usage, loop);
  co_await place.wait();
}

std::chrono::microseconds Turns::slice() const {
  const auto equal_share = tuning::kRoundOfSlices / static_cast<int>(waiting_.size() + 1);
  return std::clamp(equal_share, tuning::kShortestSlice, tuning::kLongestSlice);
}

void Turns::wake_next() {
  waiting_.begin()->second->wake();
  worked_ = {};
}

}  // namespace racebeam
