#include "server/scheduling/loops.hpp"

#include <algorithm>
#include <thread>
#include <vector>

#include <boost/asio/executor_work_guard.hpp>

namespace racebeam {

// Some clients send so much that an event is always ready. The sessions that wait for their turn do not wait
// for the end of that. The work of sessions does not count: few events would be handled while it is long.
void Loop::handle_events() {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds kLongest{2};
  const auto begin = Clock::now();
  while (context.poll_one() > 0 && Clock::now() - begin < kLongest + turns.worked()) {
  }
}

// While a loop polls, all its sessions get their turn, not only the one that it polls for.
void Loop::run() {
  const auto stay = boost::asio::make_work_guard(context);
  while (!context.stopped()) {
    if (!turns.empty()) {
      turns.wake_next();
      handle_events();
    } else if (busy.again()) {
      handle_events();
    } else {
      context.run_one();
    }
  }
}

Loops::Loops(unsigned threads, std::chrono::microseconds busy_poll, Metrics& metrics) {
  for (unsigned thread = 0; thread < std::max(1U, threads); ++thread)
    loops_.emplace_back(metrics.add_meter(), busy_poll);
}

Loop& Loops::idlest() {
  const auto fewer = [](const Loop& a, const Loop& b) { return a.sessions < b.sessions; };
  return *std::min_element(loops_.begin(), loops_.end(), fewer);
}

int Loops::sessions() const {
  int all = 0;
  for (const Loop& loop : loops_) all += loop.sessions;
  return all;
}

void Loops::run() {
  std::vector<std::jthread> threads;
  for (Loop& loop : loops_) threads.emplace_back([&loop] { loop.run(); });
}

void Loops::stop() {
  for (Loop& loop : loops_) loop.context.stop();
}

}  // namespace racebeam
