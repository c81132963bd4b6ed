#include "server/connections/memory_relief.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

using namespace racebeam;
using namespace std::chrono_literals;

namespace {

constexpr std::uint64_t kMax = std::uint64_t{16} << 20, kHalfMiB = std::uint64_t{1} << 19;

// Sessions of one owner on one loop. A second owner has no sessions.
struct Hall {
  explicit Hall(std::initializer_list<std::uint64_t> sessions = {}) {
    for (const std::uint64_t bytes : sessions) enter(bytes);
  }

  Client& enter(std::uint64_t bytes) {
    clients.push_back(std::make_unique<Client>(Socket(loop.context), loop, "client", all, 0));
    clients.back()->memory()->take_anyway(bytes);
    set.insert(clients.back().get());
    return *clients.back();
  }

  // The number of the session that would be ended so long after it was last active; -1: none.
  int first_to_end(Clock::duration idle = 1h) const {
    for (const auto& client : clients) client->mark_active();
    const Client* const found = most_burdensome(set, clients.back()->last_active() + idle);
    for (std::size_t number = 0; number < clients.size(); ++number)
      if (clients[number].get() == found) return static_cast<int>(number);
    return -1;
  }

  std::shared_ptr<MemoryBudget> all = std::make_shared<MemoryBudget>(kMax);
  std::shared_ptr<MemoryBudget> other = MemoryBudget::part(all, "other");
  Metrics metrics;
  Loops loops{1, 0us, metrics};
  Loop& loop = loops.first();
  std::vector<std::unique_ptr<Client>> clients;
  std::unordered_set<Client*> set;
};

}  // namespace

TEST_CASE(
    "of idle sessions, the one that holds most is ended first, and none that holds less than the mean") {
  Hall hall{100, 300, 200};
  CHECK(hall.first_to_end() == 1);
  hall.clients[1]->working = true;
  CHECK(hall.first_to_end() == 2);  // it holds the mean
  hall.clients[2]->working = true;
  CHECK(hall.first_to_end() == -1);
}

TEST_CASE("a session is idle after two seconds") {
  Hall hall{100};
  CHECK(hall.first_to_end(2s) == -1);
  CHECK(hall.first_to_end(2s + 1ns) == 0);
}

TEST_CASE("sessions of an owner that holds less than the mean of the owners stay") {
  Hall hall{100};
  hall.other->take_anyway(100);
  CHECK(hall.first_to_end() == 0);  // each holds the mean
  hall.other->take_anyway(1);
  CHECK(hall.first_to_end() == -1);
}

TEST_CASE("a session whose client does not read is ended first, whatever it holds") {
  constexpr std::size_t kOnItsWay = 65536;
  Hall hall{100, 300, 200};
  Client& slow = *hall.clients[0];
  const auto first = [&](std::size_t unsent, Clock::duration since) {
    slow.begin_sending(unsent);
    const Client* const found = most_burdensome(hall.set, slow.sends_since() + since);
    return found == &slow;
  };
  CHECK(first(kOnItsWay + 1, 1s + 1ns));
  CHECK_FALSE(first(kOnItsWay, 1h));
  CHECK_FALSE(first(kOnItsWay + 1, 1s));
  slow.working = true;
  CHECK(first(kOnItsWay + 1, 1s + 1ns));
  slow.begin_sending(kOnItsWay + 1);
  hall.clients[2]->begin_sending(kOnItsWay + 1);
  CHECK(most_burdensome(hall.set, Clock::now() + 1h) == hall.clients[2].get());  // of these, the larger
}

TEST_CASE("busy sessions are ended only of an owner that crowds out others, and idle ones before them") {
  Hall hall{kMax / 4, kMax / 4};
  for (const auto& client : hall.clients) client->working = true;
  CHECK(hall.first_to_end() == -1);  // the owner has half of the memory
  hall.clients[1]->memory()->take_anyway(1);
  CHECK(hall.first_to_end() == 1);
  hall.enter(2 * kMax / 3).working = true;
  Client& idle = hall.enter(kMax / 2);
  CHECK(hall.first_to_end() == 3);
  idle.working = true;
  CHECK(hall.first_to_end() == 2);
  hall.other.reset();  // nobody else is there
  CHECK(hall.first_to_end() == -1);
}

TEST_CASE("sessions that end are not counted again, nor those without a limit") {
  Hall hall{100};
  hall.clients[0]->end(ErrorCode::kBusy, "enough");
  CHECK(hall.first_to_end() == -1);
  Client unlimited(Socket(hall.loop.context), hall.loop, "unlimited", nullptr, 0);
  CHECK(most_burdensome({&unlimited}, Clock::now() + 1h) == nullptr);
  CHECK(MemoryRelief(1).relieve({&unlimited}) == 0);
  CHECK(MemoryRelief(1).relieve({}) == 0);
}

TEST_CASE("at the second look, a loop ends sessions that hold its part of the shortage") {
  for (const auto& [loops, ended] : {std::pair(1U, 11), {2U, 6}}) {
    Hall hall;
    for (int session = 0; session < 40; ++session) hall.enter(kHalfMiB).working = true;
    REQUIRE(hall.all->shortage() == 10 * kHalfMiB);
    MemoryRelief relief(loops);
    CHECK(relief.relieve(hall.set) == 0);
    CHECK(relief.relieve(hall.set) == ended);
    int ending = 0;
    for (const auto& client : hall.clients) ending += client->ending();
    CHECK(ending == ended);
  }
}

TEST_CASE("memory that was enough meanwhile begins anew, and clients that pause rest once") {
  Hall hall{kMax};
  Client& client = *hall.clients[0];
  int rests = 0;
  client.on_idle = [&rests] { ++rests; };
  client.working = true;
  MemoryRelief relief(1);
  CHECK(relief.relieve(hall.set) == 0);
  client.memory()->give_back(kMax);
  CHECK(relief.relieve(hall.set) == 0);
  client.memory()->take_anyway(kMax);
  CHECK(relief.relieve(hall.set) == 0);
  CHECK(rests == 0);
  client.working = false;
  client.mark_active();
  for (const auto& [pause, expected] : {std::pair(0ms, 0), {300ms, 1}, {0ms, 1}}) {
    std::this_thread::sleep_for(pause);
    CHECK(MemoryRelief(1).relieve(hall.set) == 0);
    CHECK(rests == expected);
  }
}
