// Replies at the end of an episode, and the beginning of the next.
#include <catch2/catch.hpp>

#include "tests/protocol/duel.hpp"

using namespace racebeam;
using test::code;
using test::duel_service;
using test::LineClient;
using test::value;

namespace {

struct Short : LineClient {  // episodes of four frames
  explicit Short(const std::string& words = "") : LineClient(duel_service()) {
    REQUIRE(code(ask("load duel seed=7 sticky=0 max_episode_frames=4 " + words)) == "");
    ask("observe reward ends acts episode_frame");
  }
};

}  // namespace

TEST_CASE("An act that does nothing, since the episode is over, says so") {
  Short client;
  CHECK(client.ask("act RIGHT*9") == "ok reward=4 terminated=0 truncated=1 acts=4 episode_frame=4");
  const std::string over = "ok over=1 reward=0 terminated=0 truncated=1 acts=0 episode_frame=4";
  CHECK(client.ask("act RIGHT*9 LEFT") == over);
  CHECK(client.ask("look") == over);
  CHECK(value(client.ask("reset"), "over") == "(none)");
  CHECK(value(client.ask("act RIGHT"), "over") == "(none)");
  client.say("poke 17 01\nact NOOP\nobserve none\n");
  CHECK(client.ask("act NOOP") == "ok over=1");
}

TEST_CASE("A machine that waits for restart says that a step did nothing") {
  Short client;
  client.ask("open 2 autoreset=disabled");
  for (int step = 0; step < 4; ++step) CHECK(value(client.ask("step NOOP"), "over", 2) == "(none)");
  client.ask("restart 10");
  const std::string reply = client.ask("step RIGHT");
  CHECK(value(reply, "over", 1) == "(none)");
  CHECK(value(reply, "over", 2) == "1");
}

TEST_CASE("With autoreset an act after the end is a reset") {
  Short with("autoreset=1"), without;
  for (Short* client : {&with, &without}) client->ask("act RIGHT*9");
  CHECK(with.ask("act RIGHT*9") == without.ask("reset"));
  CHECK(with.ask("act RIGHT*3") == without.ask("act RIGHT*3"));
  CHECK(code(with.ask("act RIGHT*3 HOP")) == "bad-action");
}

TEST_CASE("With autoreset one machine plays as one of open does by default") {
  Short one("autoreset=1 frame_skip=2-3"), many("frame_skip=2-3");
  many.ask("open 1");
  for (int step = 0; step < 50; ++step)
    CHECK("ok machines=1 |" + one.ask("act RIGHT").substr(2) == many.ask("step RIGHT"));
}
