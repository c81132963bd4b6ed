// Tasks, whose allocations fail one after the other.
#include "server/scheduling/task.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include <boost/asio.hpp>

#include "server/scheduling/keep_running.hpp"
#include "server/scheduling/line_pace.hpp"

using namespace racebeam;
using namespace std::chrono_literals;
namespace net = boost::asio;

namespace {

int until_failure = 0;  // allocations; 0: none fails
int alive = 0;          // allocations that were not freed

}  // namespace

void* operator new(std::size_t size) {
  void* const memory = until_failure != 0 && --until_failure == 0 ? nullptr : std::malloc(size);
  if (memory == nullptr) throw std::bad_alloc();
  ++alive;
  return memory;
}
void operator delete(void* memory) noexcept {
  if (memory != nullptr) --alive;
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept { operator delete(memory); }

namespace {

// Two ends of a connection, and a loop whose handlers may throw.
struct Pair {
  Pair() { net::local::connect_pair(one, other); }

  // Runs as a loop of the server does. Returns how many exceptions have left a handler.
  int run() {
    int failures = 0;
    for (bool more = true; more;) {
      try {
        more = context.run_for(1s) > 0 && !context.stopped();
      } catch (...) {
        ++failures;
        Operation::fail_abandoned(std::current_exception());
      }
    }
    return failures;
  }

  net::io_context context{1};
  net::local::stream_protocol::socket one{context}, other{context};
};

Task<std::size_t> receive(Pair& pair, std::string& text) {
  net::steady_timer timer(pair.context, 1ms);
  co_await timer.async_wait(use_task);
  co_return co_await net::async_read(pair.other, net::buffer(text), use_task);
}

Task<> converse(Pair& pair, std::string& answer, bool& failed) {
  try {
    const std::string question(answer.size(), 'x');
    co_await net::async_write(pair.one, net::buffer(question), use_task);
    co_await receive(pair, answer);
  } catch (const std::bad_alloc&) {
    failed = true;
  }
}

Task<> count_to(int& counter, int end) {
  if (++counter < end) throw std::runtime_error("again");
  co_return;
}

}  // namespace

TEST_CASE("a task that cannot allocate gets an exception, wherever that is, and nothing is left") {
  int failing = 0;
  for (bool reached = true; reached; ++failing) {
    std::string answer(100, ' ');
    bool failed = false, refused = false;
    Pair pair;
    const int before = alive;
    until_failure = failing + 1;
    try {
      spawn(pair.context, converse(pair, answer, failed));
    } catch (const std::bad_alloc&) {
      refused = true;
    }
    pair.run();
    reached = until_failure == 0;
    until_failure = 0;
    INFO("allocation " << failing + 1);
    CHECK((refused || failed || answer == std::string(100, 'x')));
    CHECK((failed || refused) == reached);
    CHECK(alive - before < 8);  // what the loop keeps for the next operations
  }
  CHECK(failing > 5);
}

TEST_CASE("a task that waits is destroyed with its loop") {
  const int before = alive;
  {
    std::string answer(100, ' ');
    Pair pair;
    spawn(pair.context,
          [](Pair& all, std::string& text) -> Task<> { co_await receive(all, text); }(pair, answer));
    pair.context.run_for(20ms);
  }
  CHECK(alive == before);
}

TEST_CASE("what keeps running begins again after an exception") {
  net::io_context context{1};
  int counter = 0;
  keep_running(context, "counting", [&counter] { return count_to(counter, 3); });
  context.run_for(10s);
  CHECK(counter == 3);
}

TEST_CASE("a failure that repeats has a line of the log at first, and one every ten seconds") {
  LinePace pace;
  const LinePace::Clock::time_point start{};
  std::vector<int> lines;
  for (int tenth = 0; tenth <= 250; ++tenth)
    if (pace.is_due(start + tenth * 100ms)) lines.push_back(tenth);
  CHECK(lines == std::vector<int>{0, 100, 200});
}
