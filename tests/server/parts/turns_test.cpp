#include "server/scheduling/turns.hpp"

#include <algorithm>
#include <chrono>
#include <functional>
#include <future>
#include <string>
#include <thread>
#include <vector>

#include <boost/asio/post.hpp>
#include <catch2/catch.hpp>

#include "server/scheduling/loops.hpp"

using namespace racebeam;
using namespace std::chrono_literals;
namespace net = boost::asio;

namespace {

// A loop of sessions that work without a pause, as in the server.
struct Busy {
  // Notes its name at each slice, which takes `work`.
  Task<> session(char name, Usage& usage, int slices, Turns::Duration work) {
    for (; slices > 0; --slices) {
      if (!turns.may_work(usage)) co_await turns.wait(context, usage);
      turns.worked(usage, work);
      worked += name;
    }
  }

  void begin(char name, Usage& usage, int slices, Turns::Duration work = 2ms) {
    spawn(context, session(name, usage, slices, work));
    context.poll();
  }

  void wake(int count) {
    for (; count > 0 && !turns.empty(); --count) {
      turns.wake_next();
      context.poll();
    }
  }

  Turns turns;
  net::io_context context{1};
  std::string worked;
};

}  // namespace

TEST_CASE("sessions that work for long take turns") {
  Busy busy;
  Usage one{}, other{};
  busy.begin('a', one, 4);
  busy.begin('b', other, 4);
  busy.wake(100);
  CHECK(busy.worked == "abababab");
}

TEST_CASE("a session whose slices are short has more of them") {
  Busy busy;
  Usage one{}, other{};
  busy.begin('a', one, 3, 2ms);
  busy.begin('b', other, 8, 500us);
  busy.wake(100);
  CHECK(busy.worked == "abbbbabbbba");
}

TEST_CASE("after a pause a short request comes next, and what was not used is not saved") {
  Busy busy;
  Usage one{}, other{}, brief{};
  busy.begin('a', one, 50);
  busy.begin('b', other, 50);
  busy.wake(20);
  busy.worked.clear();
  busy.begin('c', brief, 4);
  busy.wake(6);
  CHECK(busy.worked.front() == 'c');
  CHECK(std::ranges::count(busy.worked, 'c') <= 3);
}

TEST_CASE("a session that was alone does not pay for it when others come") {
  Busy busy;
  Usage one{}, others[3] = {};
  busy.begin('a', one, 1000);
  busy.wake(900);
  busy.worked.clear();
  for (Usage& other : others) busy.begin('b', other, 100);
  busy.wake(8);
  CHECK(busy.worked.find('a') != std::string::npos);
}

TEST_CASE("a turn lasts while other sessions work") {
  Busy busy;
  Usage one{}, other{};
  busy.begin('a', one, 2);
  busy.turns.wake_next();
  busy.turns.worked(other, 1s);
  busy.context.poll();
  CHECK(busy.worked == "aa");
}

TEST_CASE("without others that wait, sessions work until the turn has lasted as long as the longest slice") {
  Turns turns;
  Usage one{}, other{};
  CHECK(turns.may_work(one));
  turns.worked(one, 2ms - 1us);
  CHECK(turns.may_work(other));
  turns.worked(other, 1us);
  CHECK(turns.worked() == 2ms);
  CHECK_FALSE(turns.may_work(one));
  CHECK_FALSE(turns.may_work(other));
}

TEST_CASE("a session that comes is treated as if it had worked until now, less a credit of 250 us") {
  Turns turns;
  Usage one{}, other{}, ahead{1s};
  for (int slice = 0; slice < 2; ++slice) turns.worked(one, 4ms);  // each costs 20 us more
  CHECK(one == 8040us);
  turns.may_work(other);
  CHECK(other == 4020us - 250us);
  turns.may_work(ahead);
  CHECK(ahead == 1s);
}

TEST_CASE("a slice that another program interrupted costs a session as much as two slices") {
  Busy busy;
  Usage interrupted{}, other{}, usages[63] = {};
  busy.turns.worked(interrupted, 1s);
  CHECK(interrupted == 2 * 2ms + 20us);
  for (Usage& usage : usages) busy.begin('a', usage, 2);
  REQUIRE(busy.turns.slice() == 250us);
  busy.turns.worked(other, 499us);
  CHECK(other == 499us + 20us);
  busy.turns.worked(other, 1s);
  CHECK(other == 499us + 20us + 500us + 20us);
}

TEST_CASE("slices are shorter while many wait") {
  Busy busy;
  std::vector<Usage> usages(100);
  CHECK(busy.turns.slice() == 2ms);
  for (Usage& usage : usages) busy.begin('a', usage, 2);
  CHECK(busy.turns.slice() == 250us);
}

TEST_CASE("sessions with equal usage are woken in the order in which they came") {
  Busy busy;
  std::vector<Usage> usages(26);
  busy.turns.worked(usages[0], 2ms);  // nobody may work at once
  usages[0] = {};
  for (std::size_t i = 0; i < usages.size(); ++i) busy.begin(static_cast<char>('a' + i), usages[i], 1);
  busy.wake(100);
  CHECK(busy.worked == "abcdefghijklmnopqrstuvwxyz");
}

TEST_CASE("a session gets its turn though events are always ready") {
  Metrics metrics;
  Loops loops(1, 0us, metrics);
  Loop& loop = loops.first();
  const std::function<void()> again = [&] { net::post(loop.context, again); };
  net::post(loop.context, again);
  Usage usage{};
  std::promise<void> turn;
  const auto session = [&]() -> Task<> {
    co_await loop.turns.wait(loop.context, usage);
    turn.set_value();
  };
  spawn(loop.context, session());
  std::jthread thread([&] { loop.run(); });
  CHECK(turn.get_future().wait_for(10s) == std::future_status::ready);
  loop.context.stop();
}
