#include "server/scheduling/loops.hpp"

#include <algorithm>
#include <exception>
#include <new>
#include <optional>

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/steady_timer.hpp>

#include "protocol/running/fiber_stack.hpp"
#include "server/tuning.hpp"

namespace racebeam {

// Makes a timer, so that the context opens the files that it needs now rather than with the first client.
Loop::Loop(Meter& counting, std::chrono::microseconds busy_poll) : meter(counting), busy(busy_poll) {
  const boost::asio::steady_timer first(context);
}

// Some clients send so much that an event is always ready. The time is limited, so that the sessions that
// wait get their turn. The work of sessions does not count: if it did, few events would be handled after long
// work.
void Loop::handle_events() {
  constexpr auto now = std::chrono::steady_clock::now;
  const auto begin = now();
  while (context.poll_one() > 0 && now() - begin < tuning::kLongestEvents + turns.worked()) {
  }
}

// While a loop polls for one session, its other sessions get their turn, too.
void Loop::handle_next() {
  if (!turns.empty()) {
    turns.wake_next();
    handle_events();
  } else if (busy.again()) {
    handle_events();
  } else {
    context.run_one();
  }
}

// If memory runs out, an exception leaves a handler. It ends one session, not the loop.
void Loop::run() {
  const auto stay = boost::asio::make_work_guard(context);
  while (!context.stopped()) {
    std::exception_ptr failure;
    try {
      handle_next();
    } catch (...) {
      failure = std::current_exception();
    }
    if (!failure) continue;
    report_failure(failure);
    Operation::fail_abandoned(failure);
  }
}

Loops::Loops(unsigned threads, std::chrono::microseconds busy_poll, Metrics& metrics) {
  for (unsigned thread = 0; thread < std::max(1U, threads); ++thread)
    loops_.emplace_back(metrics.add_meter(), busy_poll);
}

Loop& Loops::least_loaded() {
  const auto fewer = [](const Loop& a, const Loop& b) { return a.sessions < b.sessions; };
  return *std::min_element(loops_.begin(), loops_.end(), fewer);
}

int Loops::sessions() const {
  int all = 0;
  for (const Loop& loop : loops_) all += loop.sessions;
  return all;
}

Loops::~Loops() {
  stop();
  run();  // ends threads that still wait for it
}

void Loops::start() {
  for (Loop& loop : loops_) {
    threads_.emplace_back([this, &loop] { work(loop); });
    loop.started.wait();
    if (failure_) std::rethrow_exception(failure_);
  }
}

void Loops::work(Loop& loop) {
  std::optional<FiberStack> first;
  try {
    first.emplace();  // later, the C library would abort without memory to register a thread's destructors
  } catch (const std::bad_alloc&) {
    failure_ = std::current_exception();
  }
  loop.started.open();
  if (!first) return;
  running_.wait();
  loop.run();
}

void Loops::run() {
  running_.open();
  threads_.clear();
}

void Loops::stop() {
  for (Loop& loop : loops_) loop.context.stop();
}

}  // namespace racebeam
