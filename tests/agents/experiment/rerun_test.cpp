#include "agents/experiment/rerun.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "system/invalid_input.hpp"
#include "tests/agents/experiment/verified.hpp"

using namespace racebeam;
using namespace racebeam::test;

namespace {

struct Rerun {
  RerunVerdict verdict;
  std::string findings;
};

// Runs all units again, unless `units` is fewer.
Rerun rerun_of(const ResultsFolder& folder, int units = 1000, std::uint32_t seed = 1,
               const std::string& version = "0.1.0") {
  Rerun result;
  result.verdict = rerun(folder, Images(), {.units = units, .seed = seed, .threads = 2, .version = version},
                         [&](const std::string& line) { result.findings += line + "\n"; });
  return result;
}

constexpr auto kFewUnits = R"(games = ["beamfall"]
agents = ["random", "basic"]
trials = 2
training_episodes = 2
evaluation_episodes = 2
background_screens = 300
environment = "max_episode_frames=1000 sticky=0.25"
)";

}  // namespace

TEST_CASE("Units that are played again give the same rows") {
  const Scratch place;
  const ResultsFolder folder(place.path("results"));
  run(bound_plan(kFewUnits), folder);
  const Rerun all = rerun_of(folder);
  INFO(all.findings);
  CHECK(all.verdict.same == 3);
  CHECK(all.verdict.different == 0);
  CHECK_THAT(all.findings, Catch::Contains("beamfall-basic-2: played again, and all rows are the same\n"));

  SECTION("a seed chooses them") {
    CHECK(rerun_of(folder, 1, 5).findings == rerun_of(folder, 1, 5).findings);
    std::set<std::string> chosen;
    for (std::uint32_t seed = 1; seed <= 20; ++seed) chosen.insert(rerun_of(folder, 1, seed).findings);
    CHECK(chosen.size() == 3);
  }
  SECTION("another version, or no plan") {
    CHECK_THROWS_WITH(rerun_of(folder, 1, 1, "0.2.0"),
                      "the plan is of version '0.1.0'; this program is 0.2.0");
    std::filesystem::remove(folder.plan());
    CHECK_THROWS_WITH(rerun_of(folder), Catch::Contains("has no plan.toml"));
  }
  SECTION("episodes of another agent, whose replay is right") {
    reseal(folder, 2, [](EpisodeLog& log) {
      PlaySettings play = settings_of(log);
      const EpisodeOrigin origin = log.origin;
      FixedPolicy other(2, 1, 1);
      Stage stage(beamfall(), play, Drawing::kNone);
      stage.begin(play.machine.random_seed);
      const Episode episode = racebeam::play(other, stage);
      log.end = episode.end;
      log.hashes = episode.hashes;
      log.actions = episode.actions;
      log.origin = origin;
    });
    REQUIRE(verified(folder).verdict.wrong == 0);
    const std::vector<ResultRow> rows = rows_of(contents(folder.results()));
    const Rerun found = rerun_of(folder);
    CHECK(found.verdict.same == 2);
    CHECK(found.verdict.different == 1);
    CHECK_THAT(found.findings,
               Catch::Contains("beamfall-basic-1: not the same: results.csv, episode 1: score is " +
                               field(rows[2], "score") + "; played again, the agent has "));
  }
  SECTION("a score of training that was raised") {
    std::string curves = contents(folder.curves());
    const std::size_t line = curves.find("beamfall-basic-2,beamfall,basic,2,1,");
    REQUIRE(line != std::string::npos);
    curves.insert(line + std::string("beamfall-basic-2,beamfall,basic,2,1,").size(), "9");
    write(folder.curves(), curves);
    const Rerun found = rerun_of(folder);
    CHECK(found.verdict.different == 1);
    CHECK_THAT(found.findings,
               Catch::Contains("beamfall-basic-2: not the same: curves.csv, episode 1: score is 9"));
  }
  SECTION("a row that was left out") {
    const std::string table = contents(folder.results());
    write(folder.results(), table.substr(0, table.rfind('\n', table.size() - 2) + 1));
    CHECK_THAT(
        rerun_of(folder).findings,
        Catch::Contains("beamfall-basic-2: not the same: results.csv has 1 rows; played again it has 2"));
  }
}

TEST_CASE("A plan's phrase gives the seeds of its evaluation, and verification knows them") {
  const Scratch place;
  const ResultsFolder folder(place.path("results"));
  const Plan plan = bound_plan(std::string(kFewUnits) + "phrase = \"a phrase\"\n");
  run(plan, folder);
  const std::vector<ResultRow> rows = rows_of(contents(folder.results()));
  CHECK(field(rows[1], "environment_seed") == "221384134");
  CHECK(verified(folder).verdict.confirmed == rows.size());
  const std::string table = contents(folder.results());
  write(folder.results(), altered_field(table, 1, 6, field(rows[0], "environment_seed")));
  CHECK_THAT(verified(folder).findings,
             Catch::Contains("environment_seed is '" + field(rows[0], "environment_seed") +
                             "'; the plan gives '221384134'"));
  CHECK_THROWS_WITH(bound_plan("phrase = \"a\\\\b\"\n"),
                    Catch::StartsWith("test.toml:1: phrase: a phrase has"));
}
