#include "agents/experiment/play.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "protocol/line/loaded_machine.hpp"
#include "system/invalid_input.hpp"
#include "tests/agents/experiment/samples.hpp"

using namespace racebeam;
using namespace racebeam::test;

TEST_CASE("A log that is played again gives the same score, frames, end and states") {
  for (const float sticky : {0.0F, 0.25F}) {
    PlaySettings play = short_episodes();
    play.machine.sticky = sticky;
    const EpisodeLog log = random_log(play);
    for (const CpuKind cpu : {CpuKind::kAuto, CpuKind::kInterpreter}) {
      const Replay played = Replayer(1, cpu).play(log, beamfall());
      CHECK(played.end == log.end);
      CHECK(played.hashes == log.hashes);
    }
  }
}

TEST_CASE("Logs that are played one after the other are played as each without the others") {
  const auto logs = [] {
    std::vector<EpisodeLog> all;
    for (const std::uint32_t seed : {1U, 2U, 3U, 2U}) {
      PlaySettings play = short_episodes();
      play.machine.sticky = seed == 3 ? 0.25F : 0.5F;
      play.machine.random_seed = seed;
      all.push_back(random_log(play));
    }
    return all;
  }();
  const Cartridge cartridge = beamfall();
  for (const unsigned machines : {0U, 1U, 4U}) {
    Replayer replayer(machines, CpuKind::kAuto);
    for (const EpisodeLog& log : logs) {
      const Replay played = replayer.play(log, cartridge);
      CHECK(played.end == log.end);
      CHECK(played.hashes == log.hashes);
    }
  }
}

TEST_CASE("An episode has a hash after every 256 decisions, and one of its end") {
  const EpisodeLog log = random_log(short_episodes());
  CHECK(log.actions.size() == static_cast<std::size_t>(log.end.decisions));
  CHECK(log.hashes.size() == hashes_of(log.actions.size()));
  CHECK(log.end.frames <= 3000);
  CHECK(hashes_of(0) == 1);
  CHECK(hashes_of(255) == 1);
  CHECK(hashes_of(256) == 2);
}

TEST_CASE("An episode begins as a machine that was constructed with its seed") {
  PlaySettings play = short_episodes();
  play.machine.sticky = 0.25F;
  play.machine.random_seed = 99;
  play.difficulty = 0;
  Stage stage(beamfall(), play, Drawing::kNone);
  for (int i = 0; i < 30; ++i) stage.machine().act(1);
  stage.begin(99);
  Environment fresh(beamfall().image, beamfall().game, play.machine);
  fresh.set_difficulty(0);
  fresh.reset_game();
  for (int i = 0; i < 200; ++i) {
    REQUIRE(fresh.act(i % 18) == stage.machine().act(i % 18));
    REQUIRE(fresh.state_hash() == stage.machine().state_hash());
  }
}

TEST_CASE("Settings that a log could not repeat are refused") {
  PlaySettings play = short_episodes();
  play.autoreset = Autoreset::kNextStep;
  CHECK_THROWS_AS(Stage(beamfall(), play, Drawing::kNone), InvalidInput);
}

TEST_CASE("An episode begins with the no-ops of load, drawn by its seed") {
  PlaySettings play = short_episodes();
  play.noop_max = 30;
  play.machine.sticky = 0.25;
  Stage stage(beamfall(), play, Drawing::kNone);
  std::set<int> numbers;
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    play.machine.random_seed = seed;
    Slot slot(beamfall(), slot_settings(play));
    stage.begin(seed);
    INFO(seed);
    CHECK(stage.machine().state_hash() == slot.environment().state_hash());
    CHECK(stage.machine().episode_frame_number() == slot.environment().episode_frame_number());
    for (int i = 0; i < 50; ++i) CHECK(stage.machine().act(i % 18) == slot.environment().act(i % 18));
    CHECK(stage.machine().state_hash() == slot.environment().state_hash());
    numbers.insert(Noops(seed, 30).draw());
  }
  CHECK(numbers.size() > 5);
}

TEST_CASE("Logs with no-ops and minimal actions are played again, and other actions are refused") {
  PlaySettings play = short_episodes();
  play.noop_max = 30;
  play.action_set = ActionSet::kMinimal;
  const Cartridge updraft{load_image("builtin:updraft"), find_game("updraft")};
  const std::vector<int>& minimal = updraft.game->minimal_actions;
  FixedPolicy agent(minimal[0], 0, 7, minimal);
  EpisodeLog log = log_of_episode(agent, play, 7, updraft);
  for (const int action : log.actions) REQUIRE(std::ranges::find(minimal, action) != minimal.end());
  const Replay played = Replayer(1, CpuKind::kAuto).play(log, updraft);
  CHECK(played.end == log.end);
  CHECK(played.hashes == log.hashes);
  int other = 0;
  while (std::ranges::find(minimal, other) != minimal.end()) ++other;
  log.actions[3] = static_cast<std::uint8_t>(other);
  CHECK_THROWS_WITH(Replayer(1, CpuKind::kAuto).play(log, updraft),
                    Catch::Contains("which is not in the set minimal"));
}

namespace {

// Counts the episodes that it is told of.
class Counting final : public Agent {
 public:
  int begin(const Environment&) override { return ++begins, 0; }
  int next(double, const Environment&) override { return 0; }
  void end(double) override { ++ended; }
  void write(StateWriter&) const override {}
  void read(StateReader&) override {}

  int begins = 0, ended = 0;
};

}  // namespace

TEST_CASE("A lost life ends an episode for the agent only where it is to") {
  Counting whole, lives;
  Stage stage(beamfall(), short_episodes(18000), Drawing::kNone);
  stage.begin(1);
  const int first = stage.machine().lives();
  REQUIRE(first > 1);
  const Episode expected = play(whole, stage);
  REQUIRE(expected.end.over == EpisodeOver::kTerminated);
  stage.begin(1);
  const Episode same = play(lives, stage, {.lives_end = true});
  CHECK(same.end == expected.end);  // the game goes on
  CHECK(same.actions == expected.actions);
  CHECK(whole.begins == 1);
  CHECK(lives.begins == first - expected.end.lives);
  CHECK(lives.ended == lives.begins);
}
