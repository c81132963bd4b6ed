#include "agents/experiment/verify_submission.hpp"

#include <catch2/catch.hpp>

#include "system/invalid_input.hpp"
#include "tests/agents/experiment/verified.hpp"

using namespace racebeam;
using namespace racebeam::test;

namespace fs = std::filesystem;

namespace {

// Sticky actions, so that the seed decides what an episode gives.
PlaySettings sticky_episodes(int frames = 3000) {
  PlaySettings play = short_episodes(frames);
  play.machine.sticky = 0.25;
  return play;
}

// Three episodes of random play, without a plan.
void make_submission(const ResultsFolder& folder) {
  std::string table = line_of(kResultColumns);
  fs::create_directories(folder.logs("mine-1"));
  for (int episode = 1; episode <= 3; ++episode) {
    EpisodeLog log = random_log(sticky_episodes(), static_cast<std::uint32_t>(episode));
    log.origin = {"mine-1", "mine", 1, episode, 5, "2.0"};
    const std::string bytes = bytes_of(log);
    write(folder.log("mine-1", std::to_string(episode)), bytes);
    table += line_of(row_of(log, sha256_of(bytes)));
  }
  write(folder.results(), table);
  write(folder.root() + "/agent.toml", "agent = \"mine\"\n");
}

Verified of_submission(const ResultsFolder& folder) {
  Verified result;
  result.verdict = verify_submission(folder, Images(), 2, CpuKind::kAuto,
                                     [&](const std::string& line) { result.findings += line + "\n"; });
  return result;
}

}  // namespace

TEST_CASE("A submission's rows are confirmed without a plan, and every alteration is named") {
  const Scratch place;
  const ResultsFolder folder(place.path("mine"));
  make_submission(folder);
  REQUIRE(is_submission(folder));
  const Verified good = of_submission(folder);
  INFO(good.findings);
  REQUIRE(good.verdict.confirmed == 3);
  REQUIRE(good.verdict.wrong == 0);
  const std::string table = contents(folder.results());
  const auto refused = [&](const std::string& sentence) {
    const Verified found = of_submission(folder);
    CHECK(found.verdict.wrong >= 1);
    CHECK_THAT(found.findings, Catch::Contains(sentence));
  };

  SECTION("each column") {
    for (std::size_t column = 0; column < kResultColumns.size(); ++column) {
      INFO(kResultColumns[column]);
      write(folder.results(), altered_field(table, 1, column, "1234"));
      const Verified found = of_submission(folder);
      CHECK(found.verdict.confirmed == 2);
      CHECK(found.verdict.wrong >= 1);
    }
  }
  SECTION("a score raised by one in the row and its log") {
    reseal(folder, 0, [](EpisodeLog& log) { ++log.end.score; });
    refused("not confirmed: score is ");
  }
  SECTION("an action that was changed") {
    reseal(folder, 0, [](EpisodeLog& log) { log.actions[100] = log.actions[100] == 3 ? 4 : 3; });
    refused("results.csv:2 (mine-1, episode 1): not confirmed: ");
  }
  SECTION("a swapped seed") {
    const EpisodeLog other = log_of("2.episode", contents(folder.log("mine-1", "2")));
    reseal(folder, 0, [&](EpisodeLog& log) { log.settings = other.settings; });
    refused("not confirmed: ");
  }
  SECTION("other settings") {
    const EpisodeLog other = random_log(sticky_episodes(2000), 1);
    reseal(folder, 2, [&](EpisodeLog& log) { log.settings = other.settings; });
    refused("its log's settings are '");
  }
  SECTION("names that leave the folder") {
    for (const char* name : {"../mine-1", "..", "/etc", ""}) {
      write(folder.results(), altered_field(table, 1, 0, name));
      refused("unit and episode are accepted with letters, digits, '_', '.' and '-'");
    }
  }
  SECTION("a row that stands twice, and a log that no row has") {
    std::vector<ResultRow> rows = rows_of(table);
    write(folder.results(), line_of(kResultColumns) + line_of(rows[0]) + line_of(rows[0]) + line_of(rows[1]));
    refused("not confirmed: it stands twice");
    refused("3.episode: no row of results.csv has this log");
  }
  SECTION("logs that are cut, lack, or are links") {
    const std::string path = folder.log("mine-1", "1");
    const std::string whole = contents(path);
    write(path, whole.substr(0, whole.size() - 1));
    refused("results.csv:2 (mine-1, episode 1): not confirmed: ");
    fs::remove(path);
    refused("results.csv:2 (mine-1, episode 1): not confirmed: ");
    write(place.path("elsewhere"), whole);
    fs::create_symlink(place.path("elsewhere"), path);
    refused("its log is behind a link, which is not followed");
  }
  SECTION("a folder of logs that is a link") {
    fs::rename(folder.logs(), place.path("elsewhere"));
    fs::create_directory_symlink(place.path("elsewhere"), folder.logs());
    CHECK_THROWS_AS(of_submission(folder), InvalidInput);
  }
  SECTION("a trial that diverged has no episode") {
    std::vector<ResultRow> rows = rows_of(table);
    field(rows[2], "end") = "diverged";
    write(folder.results(), line_of(kResultColumns) + line_of(rows[0]) + line_of(rows[1]) + line_of(rows[2]));
    CHECK(of_submission(folder).verdict.unchecked == 1);
  }
  SECTION("a folder with a plan is an experiment's") {
    write(folder.plan(), kPlan);
    CHECK_FALSE(is_submission(folder));
  }
}
