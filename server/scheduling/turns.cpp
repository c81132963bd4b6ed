#include "server/scheduling/turns.hpp"

#include <algorithm>

#include <boost/asio/redirect_error.hpp>
#include <boost/asio/this_coro.hpp>
#include <boost/asio/use_awaitable.hpp>

namespace racebeam {

namespace net = boost::asio;

// The timer never expires. It is cancelled to wake the session.
net::awaitable<void> Turns::wait(const Usage& usage) {
  net::steady_timer timer(co_await net::this_coro::executor, Clock::time_point::max());
  waiting_.push_back({&usage, &timer});
  boost::system::error_code cancelled;
  co_await timer.async_wait(net::redirect_error(net::use_awaitable, cancelled));
}

void Turns::wake_next() {
  const auto now = Clock::now();
  const auto next =
      std::ranges::min_element(waiting_, {}, [now](const Waiting& one) { return one.usage->lately(now); });
  next_ = next->usage;
  next->timer->cancel();
  *next = waiting_.back();
  waiting_.pop_back();
}

}  // namespace racebeam
