#include "server/connections/lobby.hpp"

#include <catch2/catch.hpp>
#include <memory>

#include "server/connections/client.hpp"

using namespace racebeam;
using namespace std::chrono_literals;

namespace {

// Clients without a token on one loop, which runs on request.
struct Hall {
  std::shared_ptr<Client> enter(const char* name) {
    auto client = std::make_shared<Client>(Socket(loop.context), loop, name, nullptr, 0);
    lobby->enter(client);
    return client;
  }

  Metrics metrics;
  Loops loops{1, 0us, metrics};
  Loop& loop = loops.first();
  std::shared_ptr<Lobby> lobby = std::make_shared<Lobby>();
};

}  // namespace

TEST_CASE("the first client without a token makes room") {
  Hall hall;
  const auto first = hall.enter("first"), second = hall.enter("second");
  CHECK(hall.lobby->make_room("full"));
  hall.loop.context.poll();
  CHECK(first->ending());
  CHECK(!second->ending());
}

TEST_CASE("a client that gives its token while it is to make room stays, and the next one goes") {
  Hall hall;
  const auto first = hall.enter("first"), second = hall.enter("second");
  CHECK(hall.lobby->make_room("full"));
  first->admitted = true;
  hall.loop.context.poll();
  CHECK(!first->ending());
  CHECK(second->ending());
  CHECK(!hall.lobby->make_room("full"));
}
