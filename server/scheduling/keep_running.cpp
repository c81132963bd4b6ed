#include "server/scheduling/keep_running.hpp"

#include <new>
#include <thread>

#include <boost/asio/steady_timer.hpp>

#include "server/operation/log.hpp"
#include "server/scheduling/line_pace.hpp"

namespace racebeam {
namespace {

using namespace std::chrono_literals;

constexpr auto kAfterFailure = 100ms, kShortSleep = 10ms;

void log_failure(const std::string& what, const std::exception& failure) noexcept {
  try {
    log(LogLevel::kError, what + " failed, and begins again: " + failure.what());
  } catch (const std::exception&) {
    log(LogLevel::kError, what);
  }
}

// If there is no memory for a pause of the task, the whole thread sleeps.
Task<> repeat(boost::asio::io_context& loop, std::string what, std::function<Task<>()> body) {
  LinePace pace;
  for (bool failed = false;; failed = true) {
    try {
      if (failed) co_await pause(loop, kAfterFailure);
      co_await body();
      co_return;
    } catch (const std::exception& failure) {
      if (pace.is_due(LinePace::Clock::now())) log_failure(what, failure);
    }
    if (failed) std::this_thread::sleep_for(kShortSleep);
  }
}

}  // namespace

Task<> pause(boost::asio::io_context& loop, std::chrono::milliseconds time) {
  boost::asio::steady_timer timer(loop, time);
  co_await timer.async_wait(use_task);
}

void keep_running(boost::asio::io_context& loop, std::string what, std::function<Task<>()> body) {
  spawn(loop, repeat(loop, std::move(what), std::move(body)));
}

void retry_until_memory(const std::function<void()>& step) {
  for (;;) {
    try {
      return step();
    } catch (const std::bad_alloc&) {
      std::this_thread::sleep_for(kShortSleep);
    }
  }
}

}  // namespace racebeam
