#include "agents/experiment/play.hpp"

#include <catch2/catch.hpp>

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
  for (const unsigned kept : {0U, 1U, 4U}) {
    Replayer replayer(kept, CpuKind::kAuto);
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
  play.noop_max = 30;
  CHECK_THROWS_AS(Stage(beamfall(), play, Drawing::kNone), InvalidInput);
}
