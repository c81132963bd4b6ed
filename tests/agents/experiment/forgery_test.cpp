// Results whose rows and logs agree, and which are not those of the plan.
#include <catch2/catch.hpp>
#include <utility>

#include "agents/experiment/verify.hpp"
#include "system/invalid_input.hpp"
#include "tests/agents/experiment/verified.hpp"

using namespace racebeam;
using namespace racebeam::test;

namespace {

constexpr auto kOneAgent = R"(games = ["beamfall"]
agents = ["random"]
evaluation_episodes = 2
environment = "max_episode_frames=1000"
)";

class Forgery {
 public:
  explicit Forgery(const char* plan = kOneAgent) : folder(place_.path("results")) {
    run(bound_plan(plan), folder);
  }

 private:
  const Scratch place_;

 public:
  const ResultsFolder folder;
};

// Ends the log after this many actions, or plays on with NOOPs, with what the machine then gives.
void set_length(EpisodeLog& log, std::size_t actions) {
  log.actions.resize(actions);
  const Replay played = Replayer(1, CpuKind::kAuto).play(log, beamfall());
  log.end = played.end;
  log.end.decisions = static_cast<std::int64_t>(actions);
  log.hashes = played.hashes;
  log.hashes.resize(hashes_of(actions));
}

}  // namespace

TEST_CASE("A log that ends before its episode is not confirmed") {
  const Forgery forgery;
  reseal(forgery.folder, 0, [](EpisodeLog& log) {
    REQUIRE(log.actions.size() > 256);
    set_length(log, 256);
    CHECK(log.end.over == EpisodeOver::kTruncated);
  });
  const Verified found = verified(forgery.folder);
  CHECK(found.verdict.confirmed == 1);
  CHECK(found.verdict.wrong == 1);
  CHECK_THAT(found.findings, Catch::Contains("the episode is not over after its last action"));
}

TEST_CASE("A log with actions after the end of its episode is not confirmed") {
  const Forgery forgery;
  reseal(forgery.folder, 0, [](EpisodeLog& log) { set_length(log, log.actions.size() + 1); });
  const Verified found = verified(forgery.folder);
  CHECK(found.verdict.confirmed == 1);
  CHECK_THAT(found.findings, Catch::Contains("decisions is '") && Catch::Contains("; the replay gives '"));
}

TEST_CASE("Rows and logs of other settings, agents, trials and versions than the plan's are not confirmed") {
  using Alteration = std::pair<std::function<void(EpisodeLog&)>, std::string>;
  const auto setting = [](const std::string& from, const std::string& to) {
    return [=](EpisodeLog& log) {
      REQUIRE(log.settings.find(from) != std::string::npos);
      log.settings.replace(log.settings.find(from), from.size(), to);
    };
  };
  const Alteration alteration = GENERATE_COPY(
      Alteration{setting("reward_max=none", "reward_max=1"),
                 "'reward_max=1'; the plan gives 'reward_max=none'"},
      Alteration{setting("color_averaging=0", "color_averaging=1"), "'color_averaging=1'; the plan gives"},
      Alteration{setting("max_episode_frames=1000", "max_episode_frames=18000"),
                 "'max_episode_frames=18000'; the plan gives 'max_episode_frames=1000'"},
      Alteration{setting("sticky=0", "sticky=0.5"), "'sticky=0.5'; the plan gives 'sticky=0'"},
      Alteration{[](EpisodeLog& log) { log.settings += " difficulty=0"; },
                 "'difficulty=0'; the plan gives nothing"},
      Alteration{[](EpisodeLog& log) { log.origin.agent = "uct"; },
                 "agent is 'uct'; the plan gives 'random'"},
      Alteration{[](EpisodeLog& log) { log.origin.trial = 7; }, "trial is '7'; the plan gives '1'"},
      Alteration{[](EpisodeLog& log) { log.origin.agent_seed = 7; }, "agent_seed is '7'; the plan gives '"},
      Alteration{[](EpisodeLog& log) { log.origin.version = "9.9"; },
                 "version is '9.9'; the plan gives '0.1.0'"},
      Alteration{[](EpisodeLog& log) { log.image_md5 = std::string(32, 'a'); }, "image_md5 is 'aaa"},
      Alteration{[](EpisodeLog& log) { log.game = "updraft"; },
                 "game is 'updraft'; the plan gives 'beamfall'"});
  const Forgery forgery;
  reseal(forgery.folder, 1, alteration.first);
  const Verified found = verified(forgery.folder);
  CHECK(found.verdict.confirmed == 1);
  CHECK(found.verdict.wrong == 1);
  CHECK_THAT(found.findings, Catch::Contains(alteration.second));
}

TEST_CASE("Settings that a log leaves out are their defaults") {
  const Forgery forgery;
  reseal(forgery.folder, 0, [](EpisodeLog& log) {
    const std::string sound = " sound=0";
    REQUIRE(log.settings.find(sound) != std::string::npos);
    log.settings.erase(log.settings.find(sound), sound.size());
  });
  CHECK(verified(forgery.folder).verdict.confirmed == 2);
}

TEST_CASE("Only learners diverge") {
  const Forgery forgery;
  const Plan plan = bound_plan(kOneAgent);
  write(forgery.folder.results(),
        line_of(kResultColumns) + line_of(row_of_divergence(plan, units_of(plan)[0])));
  const Verified found = verified(forgery.folder);
  CHECK(found.verdict.unchecked == 0);
  CHECK_THAT(found.findings, Catch::Contains("beamfall-random-1, episode 0): is not in the plan"));
}

TEST_CASE("A plan of results that lacks its images or its version is refused") {
  const Forgery forgery;
  const std::string plan = contents(forgery.folder.plan());
  std::string without = plan;
  write(forgery.folder.plan(),
        without.erase(plan.find("version"), std::string("version = \"0.1.0\"\n").size()));
  CHECK_THROWS_WITH(verified(forgery.folder), Catch::Contains("it lacks the key 'version'"));
  without = plan;
  write(forgery.folder.plan(), without.erase(without.find("beamfall = "), 11 + 32 + 3));
  CHECK_THROWS_WITH(verified(forgery.folder), Catch::Contains("the MD5 of the image of beamfall is missing"));
}

TEST_CASE("A plan with more rows than memory has is refused") {
  const Forgery forgery;
  std::string plan = contents(forgery.folder.plan());
  plan.replace(plan.find("evaluation_episodes = 2"), 23, "evaluation_episodes = 1000000");
  std::string many = plan;
  write(forgery.folder.plan(), many.replace(many.find("trials = 1"), 10, "trials = 1000"));
  CHECK_THROWS_WITH(
      verified(forgery.folder),
      Catch::Contains("the plan has 1000000000 evaluation episodes; accepted: at most 20000000"));
  many = plan;
  write(forgery.folder.plan(), many.replace(many.find("trials = 1"), 10, "trials = 1000000"));
  CHECK_THROWS_WITH(verified(forgery.folder),
                    Catch::Contains("the plan has 1000000 units; accepted: at most 100000"));
}
