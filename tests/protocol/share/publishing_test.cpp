// When a shared session makes a copy, and what the copy says of time.
#include <catch2/catch.hpp>
#include <chrono>
#include <memory>

#include "protocol/line/share.hpp"

using namespace racebeam;
using namespace std::chrono_literals;
using Clock = Snapshot::Clock;

TEST_CASE("A copy is wanted at first, and again once a watcher has looked") {
  Share share("room", 1);
  CHECK(share.is_wanted());
  CHECK(share.newest() == nullptr);
  share.publish({}, 0);
  CHECK_FALSE(share.is_wanted());
  CHECK(share.newest() != nullptr);
  CHECK(share.is_wanted());
  share.publish({}, 1);
  CHECK_FALSE(share.is_wanted());
}

TEST_CASE("A copy is due a sixtieth of a second after the last one, which says when it was made") {
  Share share("room", 1);
  const auto before = Clock::now();
  CHECK(share.is_due(before));
  share.publish({}, 0);
  const auto made = share.newest()->when;
  CHECK(made >= before);
  CHECK(made <= Clock::now());
  CHECK_FALSE(share.is_due(made));
  CHECK_FALSE(share.is_due(made + 16'600us));
  CHECK(share.is_due(made + 16'700us));
}

TEST_CASE("A copy has the frames a second since half a second or more ago") {
  Share share("room", 1);
  share.publish({}, 1000);
  const auto first = share.newest()->when;
  CHECK(share.newest()->fps == 0);
  const auto limit = first + 60s;
  while (share.newest()->fps == 0 && Clock::now() < limit) share.publish({}, 1600);
  const auto second = share.newest()->when;
  CHECK(second - first >= 500ms);
  CHECK(share.newest()->fps == Approx(600 / std::chrono::duration<double>(second - first).count()));
}

TEST_CASE("As many watchers have a place as the limit says, and leave it to others") {
  const auto share = std::make_shared<Share>("room", 2);
  auto first = Share::place(share), second = Share::place(share);
  REQUIRE(first);
  REQUIRE(second);
  CHECK_FALSE(Share::place(share));
  CHECK_FALSE(Share::place(share));
  second.reset();
  CHECK(Share::place(share));
}
