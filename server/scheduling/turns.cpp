#include "server/scheduling/turns.hpp"

#include <algorithm>

#include <boost/asio/redirect_error.hpp>
#include <boost/asio/this_coro.hpp>
#include <boost/asio/use_awaitable.hpp>

namespace racebeam {

namespace net = boost::asio;

// The timer never expires. It is cancelled to wake the session.
net::awaitable<void> Turns::wait(const Usage& usage) {
  net::steady_timer timer(co_await net::this_coro::executor, net::steady_timer::time_point::max());
  waiting_.push_back({&usage, &timer});
  boost::system::error_code cancelled;
  co_await timer.async_wait(net::redirect_error(net::use_awaitable, cancelled));
}

std::chrono::microseconds Turns::slice() const {
  constexpr std::chrono::microseconds kRound{16'000};  // of slices, one for each session that waits
  return std::clamp(kRound / static_cast<int>(waiting_.size() + 1), kShortestSlice, kLongestSlice);
}

void Turns::wake_next() {
  const auto next = std::ranges::min_element(waiting_, {}, [](const Waiting& one) { return *one.usage; });
  next->timer->cancel();
  *next = waiting_.back();
  waiting_.pop_back();
  worked_ = {};
}

}  // namespace racebeam
