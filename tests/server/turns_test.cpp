#include "server/scheduling/turns.hpp"

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <catch2/catch.hpp>

using namespace racebeam;
using namespace std::chrono_literals;
namespace net = boost::asio;

namespace {

// A loop of sessions that work without a pause, as in the server.
struct Busy {
  net::awaitable<void> session(Usage& usage, int slices) {
    for (; slices > 0; --slices) {
      if (!turns.may_work(usage)) co_await turns.wait(usage);
      turns.worked(usage, 1s);
      ++worked;
      co_await turns.wait(usage);
    }
  }

  void begin(Usage& usage, int slices) { net::co_spawn(context, session(usage, slices), net::detached); }

  int wake_all() {  // how often that took
    int woken = 0;
    for (context.poll(); !turns.empty(); context.poll()) {
      turns.wake_next();
      ++woken;
    }
    return woken;
  }

  Turns turns;
  net::io_context context{1};
  int worked = 0;
};

}  // namespace

TEST_CASE("a session that has waited for its turn works in it, and does not wait again") {
  Busy busy;
  Usage one, other;
  busy.begin(one, 10);
  busy.begin(other, 10);
  CHECK(busy.wake_all() == 20);
  CHECK(busy.worked == 20);
}

TEST_CASE("a turn is for one slice") {
  Busy busy;
  Usage one, other;
  busy.begin(one, 1);
  busy.begin(other, 1);
  busy.context.poll();
  busy.turns.wake_next();
  CHECK(busy.turns.may_work(one) != busy.turns.may_work(other));
  busy.turns.worked(one, 1s);
  CHECK(!busy.turns.may_work(one));
  CHECK(!busy.turns.may_work(other));
}
