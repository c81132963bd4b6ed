// Player B's rewards, as a client gets them.
#include <array>
#include <catch2/catch.hpp>
#include <random>

#include "tests/protocol/duel.hpp"
#include "tests/support/needed_rom.hpp"

using namespace racebeam;
using Catch::Matchers::EndsWith;
using test::code;
using test::duel_service;
using test::LineClient;
using test::value;

namespace {

struct Duel : LineClient {
  explicit Duel(const std::string& words = "") : LineClient(duel_service()) {
    REQUIRE(code(ask("load duel seed=7 sticky=0 " + words)) == "");
    ask("observe reward reward_b");
  }
};

// Player B's rewards in 600 random acts of both players; `look` must report the same.
int gains_and_losses_of_b(LineClient& client) {
  constexpr std::array kActions = {"NOOP", "FIRE",   "UP",        "RIGHT",   "LEFT",
                                   "DOWN", "UPFIRE", "RIGHTFIRE", "LEFTFIRE"};
  std::mt19937 random(5);
  int sum = 0;
  for (int act = 0; act < 600; ++act) {
    const std::string a = kActions[random() % kActions.size()], b = kActions[random() % kActions.size()];
    const std::string reward = value(client.ask("act " + a + "/" + b + "*15"), "reward_b");
    CHECK(value(client.ask("look"), "reward_b") == reward);
    sum += std::abs(std::stoi(reward));
  }
  return sum;
}

}  // namespace

TEST_CASE("The reward of player B is summed over a request, told by look, and 0 after a reset") {
  Duel client;
  CHECK(client.ask("act NOOP/RIGHT*5") == "ok reward=0 reward_b=15");
  CHECK(client.ask("act RIGHT*2 RIGHT/RIGHT*2 NOOP") == "ok reward=4 reward_b=6");
  CHECK(client.ask("look") == "ok reward=4 reward_b=6");
  CHECK(client.ask("look reward_b") == "ok reward_b=6");
  CHECK(client.ask("reset") == "ok reward=0 reward_b=0");
}

TEST_CASE("The reward of player B is limited act by act, as player A's is") {
  Duel client("frame_skip=4 reward_max=5 reward_min=-5");
  CHECK(client.ask("act RIGHT/RIGHT*3") == "ok reward=12 reward_b=15");
}

TEST_CASE("Machines tell what player B gets, also in the step that ends an episode") {
  Duel client("frame_skip=2 max_episode_frames=4");
  for (const std::string autoreset : {"next-step", "same-step", "disabled"}) {
    client.ask("open 2 autoreset=" + autoreset);
    CHECK_THAT(client.ask("step NOOP/RIGHT RIGHT"), EndsWith(" | reward=0 reward_b=6 | reward=2 reward_b=0"));
    CHECK_THAT(client.ask("step RIGHT NOOP/RIGHT"), EndsWith(" | reward=2 reward_b=0 | reward=0 reward_b=6"));
  }
}

TEST_CASE("Acts after the end give no reward, whatever a reward is raised to") {
  for (const std::string end : {"max_episode_frames=2", "life_loss_ends=0"}) {
    Duel client("reward_min=1 " + end);
    client.say("act NOOP\npoke 17 01\nact NOOP\n");
    CHECK(client.ask("act RIGHT/RIGHT*3") == "ok over=1 reward=0 reward_b=0");
  }
}

TEST_CASE("In the catalogue's games for two player B is rewarded") {
  const std::vector<std::pair<std::string, std::string>> modes = {
      {"pong", "3"},     {"boxing", "1"},  {"tennis", "1"}, {"ice_hockey", "1"},
      {"surround", "1"}, {"combat", "14"}, {"joust", "1"}};
  for (const auto& [name, mode] : modes) {
    const auto image = test::needed_rom_of(name);
    if (!image) continue;
    INFO(name);
    const Scratch folder;
    auto images = std::make_shared<Images>();
    images->add_file(folder.write(name + ".bin", {image->bytes->begin(), image->bytes->end()}));
    LineService service = test::line_service();
    service.images = images;
    LineClient client(service);
    REQUIRE(code(client.ask("load " + name + " seed=7 mode=" + mode)) == "");
    client.ask("observe reward reward_b");
    CHECK(gains_and_losses_of_b(client) > 0);
  }
}

TEST_CASE("A branch answers what both players get, where the rules know two") {
  Duel client;
  client.ask("save root");
  const std::string reply = client.ask("branch root NOOP/RIGHT*2,RIGHT,NOOP*3 RIGHT/RIGHT*4");
  CHECK(value(reply, "reward", 1) == "1");
  CHECK(value(reply, "reward_b", 1) == "6");
  CHECK(value(reply, "rewards", 1) == "0*2,1,0*3");
  CHECK(value(reply, "rewards_b", 1) == "3*2,0*4");
  CHECK(value(reply, "reward_b", 2) == "12");
  CHECK(value(reply, "rewards_b", 2) == "3*4");
  client.say("load beamfall\nsave root\n");
  CHECK(value(client.ask("branch root NOOP/RIGHT"), "reward_b", 1) == "(none)");
}

TEST_CASE("The rewards of two players take twice the room in the reply of a branch") {
  LineLimits limits;
  limits.reply = 1000;
  LineClient client(duel_service(limits));
  client.say("load beamfall\nsave root\n");
  CHECK(code(client.ask("branch root NOOP*100")) == "");
  client.say("load duel\nsave root\n");
  CHECK(code(client.ask("branch root NOOP*100")) == "limit");
}
