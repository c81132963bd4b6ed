#include "server/loops.hpp"

#include <algorithm>
#include <thread>
#include <vector>

#include <boost/asio/executor_work_guard.hpp>

namespace racebeam {

Loops::Loops(unsigned threads, Metrics& metrics) {
  for (unsigned thread = 0; thread < std::max(1U, threads); ++thread)
    loops_.emplace_back(metrics.add_meter());
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
  for (Loop& loop : loops_) {
    threads.emplace_back([&context = loop.context] {
      const auto stay = boost::asio::make_work_guard(context);
      context.run();
    });
  }
}

void Loops::stop() {
  for (Loop& loop : loops_) loop.context.stop();
}

}  // namespace racebeam
