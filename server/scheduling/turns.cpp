#include "server/scheduling/turns.hpp"

#include <algorithm>

#include <boost/asio/redirect_error.hpp>

namespace racebeam {

namespace net = boost::asio;

// A session's place among those that wait. Its destructor removes the session, if wake_next() has not done
// so.
class Turns::Place {
 public:
  Place(std::vector<Waiting>& all, Waiting one) : all_(all), timer_(one.timer) { all_.push_back(one); }
  ~Place() {
    std::erase_if(all_, [this](const Waiting& one) { return one.timer == timer_; });
  }
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;

 private:
  std::vector<Waiting>& all_;
  const net::steady_timer* timer_;
};

// The timer never expires. It is cancelled to wake the session.
Task<> Turns::wait(net::io_context& loop, const Usage& usage) {
  net::steady_timer timer(loop, net::steady_timer::time_point::max());
  const Place place(waiting_, {&usage, &timer});
  boost::system::error_code cancelled;
  co_await timer.async_wait(net::redirect_error(use_task, cancelled));
}

std::chrono::microseconds Turns::slice() const {
  const auto equal_share = tuning::kRoundOfSlices / static_cast<int>(waiting_.size() + 1);
  return std::clamp(equal_share, tuning::kShortestSlice, tuning::kLongestSlice);
}

void Turns::wake_next() {
  const auto next = std::ranges::min_element(waiting_, {}, [](const Waiting& one) { return *one.usage; });
  next->timer->cancel();
  *next = waiting_.back();
  waiting_.pop_back();
  worked_ = {};
}

}  // namespace racebeam
