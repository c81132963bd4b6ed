// What a lost life does to an episode: the same words in load, open and branch.
#include <catch2/catch.hpp>

#include "tests/protocol/duel.hpp"

using namespace racebeam;
using test::code;
using test::duel_service;
using test::LineClient;
using test::value;

namespace {

struct Life : LineClient {
  explicit Life(const std::string& words) : LineClient(duel_service()) {
    REQUIRE(code(ask("load duel seed=7 sticky=0 " + words)) == "");
    ask("observe terminated truncated game_over lives acts episode_frame");
  }

  // Plays three acts; a life is lost in the first.
  std::string lose() {
    ask("poke 18 01");
    return ask("act NOOP*3");
  }
};

}  // namespace

TEST_CASE("A lost life has the effect that load asks for") {
  CHECK(Life("").lose() == "ok terminated=0 truncated=0 game_over=0 lives=2 acts=3 episode_frame=3");
  CHECK(Life("life_loss=ignored").lose() ==
        "ok terminated=0 truncated=0 game_over=0 lives=2 acts=3 episode_frame=3");
  CHECK(Life("life_loss=reported").lose() ==
        "ok terminated=1 truncated=0 game_over=0 lives=2 acts=3 episode_frame=3");
  CHECK(Life("life_loss=end").lose() ==
        "ok terminated=1 truncated=0 game_over=0 lives=2 acts=1 episode_frame=1");
  CHECK(Life("life_loss=restart").lose() ==
        "ok terminated=1 truncated=0 game_over=0 lives=2 acts=1 episode_frame=1");
}

TEST_CASE("With the old setting life_loss_ends a lost life truncates") {
  CHECK(Life("life_loss_ends=1").lose() ==
        "ok terminated=0 truncated=1 game_over=0 lives=2 acts=1 episode_frame=1");
  CHECK(value(Life("preset=dqn2015").lose(), "terminated") == "1");
}

TEST_CASE("The settings that a reply shows have the same effect when they are loaded again") {
  for (const std::string words : {"life_loss=reported", "life_loss=end", "life_loss=restart",
                                  "life_loss_ends=1", "preset=dqn2015", "preset=dqn2015 life_loss_ends=0"}) {
    INFO(words);
    Life first(words);
    const std::string reply = first.ask("settings");
    Life again("life_loss=" + value(reply, "life_loss") +
               " life_loss_ends=" + value(reply, "life_loss_ends"));
    const std::string loss = first.lose(), second_loss = again.lose();
    for (const std::string key : {"terminated", "truncated"})
      CHECK(value(loss, key) == value(second_loss, key));
  }
}

TEST_CASE("After the end of a life an act does nothing, and a reset begins the next life or a new game") {
  for (const std::string word : {"end", "restart"}) {
    INFO(word);
    Life client("life_loss=" + word);
    client.lose();
    CHECK(client.ask("act NOOP") ==
          "ok over=1 terminated=1 truncated=0 game_over=0 lives=2 acts=0 episode_frame=1");
    const bool goes_on = word == "end";
    const std::string lives = goes_on ? "2" : "3", frame = goes_on ? "1" : "0";
    CHECK(client.ask("reset") ==
          "ok terminated=0 truncated=0 game_over=0 lives=" + lives + " acts=0 episode_frame=" + frame);
    CHECK(value(client.ask("act NOOP"), "terminated") == "0");
  }
}

TEST_CASE("The limit of frames truncates, also where a lost life would terminate") {
  Life client("life_loss=restart max_episode_frames=2");
  CHECK(client.ask("act NOOP*9") == "ok terminated=0 truncated=1 game_over=0 lives=3 acts=2 episode_frame=2");
}

TEST_CASE("With autoreset=same-step the act that loses a life begins the next episode") {
  Life client("life_loss=restart autoreset=same-step");
  CHECK(client.lose() ==
        "ok final_lives=2 final_episode_frame=1 terminated=1 truncated=0 game_over=0 lives=3 acts=1 "
        "episode_frame=0");
  CHECK(client.ask("act NOOP") == "ok terminated=0 truncated=0 game_over=0 lives=3 acts=1 episode_frame=1");
}

TEST_CASE("Machines of open whose steps are acts lose lives as the machine of load does") {
  for (const std::string word : {"ignored", "reported", "end", "restart"}) {
    INFO(word);
    Life one("life_loss=" + word), many("");
    many.ask("open 1 autoreset=disabled life_loss=" + word);
    one.ask("poke 18 01");
    one.ask("save lost");
    many.ask("import lost " + value(one.ask("export lost"), "data"));
    many.ask("restore lost machine=0");
    for (int step = 0; step < 3; ++step)
      CHECK("ok machines=1 |" + one.ask("act NOOP").substr(2) == many.ask("step NOOP"));
  }
  Life both("life_loss=reported");
  both.ask("open 1");  // has that of load
  both.ask("poke 18 01");
  both.ask("save lost");
  both.ask("restore lost machine=0");
  CHECK(value(both.ask("step NOOP"), "terminated", 1) == "1");
}

TEST_CASE("A branch ends with the life where the episode does") {
  for (const std::string word : {"ignored", "reported", "end", "restart"}) {
    INFO(word);
    Life client("life_loss=" + word);
    client.ask("poke 18 01");
    client.ask("save lost");
    const std::string branch = client.ask("branch lost keep=x NOOP,NOOP,NOOP"),
                      act = client.ask("act NOOP*3");
    for (const std::string key : {"terminated", "truncated", "acts", "lives"})
      CHECK(value(branch, key, 1) == value(act, key));
    client.ask("restore x0");
    CHECK(value(client.ask("act NOOP"), "over") == (word == "end" || word == "restart" ? "1" : "(none)"));
  }
}

TEST_CASE("A state of an episode that a life has ended is over when it is restored") {
  Life client("life_loss=end");
  client.lose();
  client.ask("save ended");
  client.ask("reset seed=8");
  CHECK(value(client.ask("restore ended"), "terminated") == "1");
  CHECK(value(client.ask("act NOOP"), "over") == "1");
  client.ask("reset");
  CHECK(value(client.ask("look"), "lives") == "2");
}
