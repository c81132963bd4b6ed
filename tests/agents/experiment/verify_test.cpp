#include "agents/experiment/verify.hpp"

#include <catch2/catch.hpp>

#include "recording/sha256.hpp"
#include "system/invalid_input.hpp"
#include "tests/agents/experiment/verified.hpp"

using namespace racebeam;
using namespace racebeam::test;

namespace fs = std::filesystem;

TEST_CASE("An experiment's results are confirmed, and every alteration is named") {
  const Scratch place;
  const ResultsFolder folder(place.path("results"));
  const Plan plan = bound_plan(kPlan);
  run(plan, folder, {.threads = 2});
  const Verified good = verified(folder);
  INFO(good.findings);
  REQUIRE(good.verdict.confirmed == 2 * 20);
  REQUIRE(good.verdict.wrong == 0);
  REQUIRE(good.verdict.unchecked == 0);
  CHECK(good.verdict.frames > 2 * 20 * 100);
  const std::string table = contents(folder.results());

  SECTION("each column of each kind of row") {
    for (const std::size_t line : {std::size_t{0}, std::size_t{5}, std::size_t{39}}) {
      for (std::size_t column = 0; column < kResultColumns.size(); ++column) {
        INFO(kResultColumns[column]);
        write(folder.results(), altered_field(table, line, column, "1234"));
        const Verified found = verified(folder);
        REQUIRE(found.verdict.confirmed == 39);
        REQUIRE(found.verdict.wrong >= 1);
        REQUIRE(found.findings != "");
      }
    }
  }
  SECTION("a score that the log agrees with, which the machine does not give") {
    const std::string path = folder.log("beamfall-random-1", "1");
    EpisodeLog log = log_of("1.episode", contents(path));
    log.end.score += 10;
    const std::string bytes = bytes_of(log);
    write(path, bytes);
    std::string altered = altered_field(table, 0, 8, std::to_string(log.end.score));
    write(folder.results(), altered_field(altered, 0, 14, sha256_of(bytes)));
    CHECK_THAT(verified(folder).findings,
               Catch::Contains("score is '" + std::to_string(log.end.score) + "'; the replay gives '" +
                               std::to_string(log.end.score - 10) + "'; every state is the same"));
  }
  SECTION("an action that was exchanged") {
    const std::string path = folder.log("beamfall-random-1", "1");
    EpisodeLog log = log_of("1.episode", contents(path));
    REQUIRE(log.actions.size() > 600);
    for (std::size_t i = 300; i < 500; ++i) log.actions[i] = 3;
    const std::string bytes = bytes_of(log);
    write(path, bytes);
    write(folder.results(), altered_field(table, 0, 14, sha256_of(bytes)));
    CHECK_THAT(verified(folder).findings,
               Catch::Contains("the first stretch that differs: decisions 257 to 512"));
  }
  SECTION("logs that were exchanged, dropped, cut and added") {
    const std::string first = folder.log("beamfall-random-1", "1"),
                      second = folder.log("beamfall-random-1", "2");
    fs::rename(first, first + ".x");
    fs::rename(second, first);
    fs::rename(first + ".x", second);
    CHECK(verified(folder).verdict.wrong == 2);
    fs::remove(first);
    CHECK_THAT(verified(folder).findings, Catch::Contains("1.episode: no such file"));
    write(first, contents(second).substr(0, 50));
    CHECK_THAT(verified(folder).findings, Catch::Contains("its checksum is wrong"));
    write(folder.log("beamfall-random-1", "3"), contents(second));
    CHECK_THAT(verified(folder).findings, Catch::Contains("3.episode: no row of results.csv has this log"));
    fs::create_directory_symlink("/usr", folder.logs() + "/usr");
    CHECK_THAT(verified(folder).findings, Catch::Contains("/usr: no row of results.csv has this log"));
  }
  SECTION("a unit's logs that are elsewhere") {
    const std::string logs = folder.logs("beamfall-random-1");
    fs::rename(logs, place.path("elsewhere"));
    fs::create_directory_symlink(place.path("elsewhere"), logs);
    CHECK(verified(folder).verdict.confirmed == 40);
    CHECK(verified(folder).verdict.wrong == 0);
  }
  SECTION("a folder of logs that is a link") {
    fs::rename(folder.logs(), place.path("elsewhere"));
    for (const std::string& target : {place.path("elsewhere"), std::string("/usr"), std::string("nowhere")}) {
      fs::create_directory_symlink(target, folder.logs());
      CHECK_THROWS_WITH(verified(folder), folder.logs() +
                                              ": this is a link, which is not followed; "
                                              "accepted is a folder");
      fs::remove(folder.logs());
    }
  }
  SECTION("a log of a row that is not in the plan, which is there") {
    fs::rename(folder.log("beamfall-random-1", "1"), folder.log("beamfall-random-1", "9"));
    write(folder.results(), altered_field(table, 0, 5, "9"));
    const Verified found = verified(folder);
    CHECK_THAT(found.findings, Catch::Contains("episode 1 is missing") &&
                                   !Catch::Contains("no row of results.csv has this log"));
    CHECK(found.verdict.wrong == 2);
  }
  SECTION("rows that are missing, doubled and too many") {
    const std::size_t last = table.rfind('\n', table.size() - 2) + 1;
    write(folder.results(), table.substr(0, last));
    Verified found = verified(folder);
    CHECK_THAT(found.findings, Catch::Contains("the row of beamfall-basic-1, episode 2 is missing"));
    CHECK(found.verdict.wrong == 2);  // its log is surplus
    write(folder.results(), table + table.substr(last));
    CHECK_THAT(verified(folder).findings, Catch::Contains("beamfall-basic-1, episode 2): stands twice"));
    write(folder.results(), altered_field(table, 0, 5, "9"));
    CHECK_THAT(verified(folder).findings,
               Catch::Contains("beamfall-random-1, episode 9): is not in the plan"));
  }
  SECTION("an experiment that goes on, and one whose logs were not kept") {
    const std::string unfinished = table.substr(0, table.find("beamfall-basic-1"));
    write(folder.results(), unfinished);
    fs::remove_all(folder.logs("beamfall-basic-1"));
    CHECK(verified(folder).verdict.wrong == 2);
    fs::create_directory(folder.work());
    Verified found = verified(folder);
    CHECK_THAT(found.findings, Catch::Contains("beamfall-basic-1: is not finished"));
    CHECK(found.verdict.wrong == 0);
    CHECK(found.verdict.unchecked == 2);
    write(folder.results(), table.substr(0, table.rfind('\n', table.size() - 2) + 1));
    CHECK_THAT(verified(folder).findings,
               Catch::Contains("the row of beamfall-basic-1, episode 2 is missing"));
    write(folder.results(), table);
    found = verified(folder);
    CHECK_THAT(found.findings, Catch::Contains("could not be checked: the unit's logs are not here"));
    CHECK(found.verdict.wrong == 0);
    CHECK(found.verdict.unchecked == 2);
  }
  SECTION("a table with the line ends of Windows") {
    std::string lines;
    for (const char letter : table) (lines += letter == '\n' ? "\r" : "") += letter;
    write(folder.results(), lines);
    const Verdict verdict = verified(folder).verdict;
    CHECK(verdict.wrong == 0);
    CHECK(verdict.unchecked == 0);
    CHECK(verdict.confirmed == 40);
  }
  SECTION("a table with other columns, and one that was cut") {
    write(folder.results(), "unit,score\n");
    CHECK_THROWS_WITH(verified(folder),
                      Catch::StartsWith("results.csv: its first line must name the columns unit,game"));
    write(folder.results(), table.substr(0, table.size() - 3));
    CHECK_THROWS_WITH(verified(folder), Catch::Contains("the last line does not end"));
    write(folder.results(), table + "a,b\n");
    CHECK_THROWS_WITH(verified(folder), Catch::Contains("the row has 2 fields"));
  }
  SECTION("a folder that is not the plan's") {
    Plan other = bound_plan(std::string("seed = 2\n") + kPlan);
    CHECK_THROWS_WITH(run(other, folder),
                      Catch::Contains("the first difference is: here 'seed = 2', there 'seed = 1'"));
    fs::remove(folder.plan());
    CHECK_THROWS_AS(verified(folder), InvalidInput);
  }
}

TEST_CASE("Rows whose image is not here are listed, and never confirmed") {
  const Scratch place;
  const ResultsFolder folder(place.path("results"));
  run(bound_plan("games = [\"beamfall\", \"updraft\"]\nagents = [\"random\"]\nevaluation_episodes = 2\n"
                 "environment = \"max_episode_frames=1000\"\n"),
      folder);
  const std::string md5 = load_image("builtin:updraft")->md5, none(32, '0');
  for (const std::size_t line : {std::size_t{2}, std::size_t{3}})
    reseal(folder, line, [&](EpisodeLog& log) { log.image_md5 = none; });
  std::string plan = contents(folder.plan());
  write(folder.plan(), plan.replace(plan.find(md5), md5.size(), none));
  const Verified found = verified(folder);
  CHECK(found.verdict.confirmed == 2);
  CHECK(found.verdict.unchecked == 2);
  CHECK(found.verdict.wrong == 0);
  CHECK_THAT(found.findings, Catch::Contains("could not be checked: no image with MD5 000"));
}

TEST_CASE("A trial that diverges has one row, which is never averaged") {
  const Scratch place;
  const ResultsFolder folder(place.path("results"));
  const Plan plan =
      bound_plan(std::string(kPlan) +
                 "[agent.basic]\nalpha = 100\nlambda = 1\nleast_trace = 0\ntraining_episodes = 50\n"
                 "reward_scale = \"none\"\n");
  run(plan, folder);
  const auto rows = rows_of(contents(folder.results()));
  REQUIRE(rows.size() == 39);
  CHECK(field(rows[38], "end") == "diverged");
  CHECK(field(rows[38], "score") == "");
  const Verified found = verified(folder);
  CHECK(found.verdict.confirmed == 38);
  CHECK(found.verdict.unchecked == 1);
  const std::string table = contents(folder.results());
  for (std::size_t column = 0; column < kResultColumns.size(); ++column) {
    INFO(kResultColumns[column]);
    write(folder.results(), altered_field(table, 38, column, "5"));
    CHECK(verified(folder).verdict.wrong >= 1);
  }
}
