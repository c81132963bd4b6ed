#include "agents/experiment/verify_submission.hpp"

#include <sstream>

#include <catch2/catch.hpp>

#include "recording/phrase_seed.hpp"
#include "recording/sha256.hpp"
#include "system/invalid_input.hpp"
#include "tests/agents/experiment/verified.hpp"
#include "tests/support/skip.hpp"

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

constexpr auto kAgent = "agent = \"mine\"\nversion = \"1\"\npreset = \"other\"\ntraining_frames = 0\n";
const std::string kPhrase = std::string(kAgent) + "phrase = \"the first headline of Sunday\"\n";

// agent.toml with another line of a key; "": without it.
std::string agent_with(const std::string& key, const std::string& line) {
  std::string text = line + (line.empty() ? "" : "\n");
  std::istringstream lines(kAgent);
  for (std::string each; std::getline(lines, each);)
    if (!each.starts_with(key + " =")) text += each + "\n";
  return text;
}

// The cells of a line of tests/evaluation/agent_files.tsv.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream text(line);
  for (std::string cell; std::getline(text, cell, '\t');) cells.push_back(cell);
  return cells;
}

// Three episodes of random play, without a plan. seed_of: by the number of the episode.
void make_submission(
    const ResultsFolder& folder, const std::string& agent = kAgent,
    const std::function<std::uint32_t(int)>& seed_of = [](int episode) {
      return static_cast<std::uint32_t>(episode);
    }) {
  std::string table = line_of(kResultColumns);
  fs::create_directories(folder.logs("mine-1"));
  for (int episode = 1; episode <= 3; ++episode) {
    EpisodeLog log = random_log(sticky_episodes(), seed_of(episode));
    log.origin = {"mine-1", "mine", 1, episode, 5, "2.0"};
    const std::string bytes = bytes_of(log);
    write(folder.log("mine-1", std::to_string(episode)), bytes);
    table += line_of(row_of(log, sha256_of(bytes)));
  }
  write(folder.results(), table);
  write(folder.root() + "/agent.toml", agent);
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
  SECTION("another preset, and another agent") {
    const std::string about = folder.root() + "/agent.toml";
    write(about, agent_with("preset", "preset = \"machado2018\""));
    refused("agent.toml: preset is 'machado2018'; the settings of the logs are those of 'other'");
    write(about, kAgent);
    CHECK(of_submission(folder).verdict.wrong == 0);
    write(about, agent_with("agent", "agent = \"yours\""));
    refused("not confirmed: agent is 'mine'; agent.toml has 'yours'");
    CHECK_THAT(of_submission(folder).findings, !Catch::Contains("no row of results.csv has this log"));
  }
  SECTION("names that leave the folder") {
    for (const char* name : {"../mine-1", "..", "/etc", ""}) {
      write(folder.results(), altered_field(table, 1, 0, name));
      refused("not confirmed: unit is '" + std::string(name) + "'; it takes 1 to 100 letters, digits, ");
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

TEST_CASE("A link among the logs is surplus, and a folder that cannot be listed is named") {
  const Scratch place;
  const ResultsFolder folder(place.path("submission"));
  make_submission(folder);
  const std::string link = folder.logs("elsewhere");
  fs::create_directory_symlink(place.path(""), link);
  const Verified found = of_submission(folder);
  CHECK(found.verdict.wrong == 1);
  CHECK(found.findings == link + ": no row of results.csv has this log\n");
  fs::remove(link);
  fs::create_directory(link);
  fs::permissions(link, fs::perms::none);
  std::error_code error;
  const fs::directory_iterator listing(link, error);
  if (!error)
    leave_out("a folder that cannot be listed: this user may list all");
  else
    CHECK_THROWS_WITH(of_submission(folder), link + ": the folder cannot be listed: Permission denied");
  fs::permissions(link, fs::perms::owner_all);
}

TEST_CASE("verify refuses an agent.toml in the words of the board") {
  const Scratch place;
  const ResultsFolder folder(place.path("mine"));
  make_submission(folder);
  const std::string path = folder.root() + "/agent.toml";
  std::istringstream cases(contents(RACEBEAM_SOURCE_DIR "/tests/evaluation/agent_files.tsv"));
  int count = 0;
  for (std::string line; std::getline(cases, line);) {
    if (line.starts_with("#")) continue;
    const std::vector<std::string> cells = cells_of(line);
    REQUIRE(cells.size() == 3);
    INFO(line);
    write(path, agent_with(cells[0], cells[1]));
    CHECK_THROWS_WITH(of_submission(folder), path + cells[2]);
    ++count;
  }
  CHECK(count > 25);
}

TEST_CASE("verify accepts an agent.toml whose values are at their limits") {
  const Scratch place;
  const ResultsFolder folder(place.path("mine"));
  const std::string words(4000, 'x'), path = folder.root() + "/agent.toml";
  const std::string rest = "link = \"\"\nrole = \"planner\"\nwords = \"" + words;
  make_submission(folder, agent_with("training_frames", "training_frames = 999999999999999") + rest + "\"\n");
  CHECK(of_submission(folder).verdict.confirmed == 3);
  write(path, kAgent + rest + "x\"\n");
  CHECK_THROWS_WITH(of_submission(folder), path + ": words has 4001 letters; expected at most 4000");
  std::string version;
  for (int letter = 0; letter < 64; ++letter) version += "ö";
  write(path, agent_with("version", "version = \"" + version + "\""));
  CHECK(of_submission(folder).verdict.confirmed == 3);
}

TEST_CASE("The seed of a phrase is the SHA-256 of phrase, game, trial and episode") {
  // printf 'a phrase\nbeamfall\n1\n2' | sha256sum | cut -c1-8; then without the highest bit
  CHECK(seed_of_phrase("a phrase", "beamfall", 1, 2) == 221384134);
  CHECK_THROWS_AS(check_phrase(""), InvalidInput);
  CHECK_THROWS_AS(check_phrase("two\nlines"), InvalidInput);
  CHECK_THROWS_AS(check_phrase("a \"word\""), InvalidInput);
  CHECK_THROWS_AS(check_phrase(std::string(1001, 'a')), InvalidInput);
  CHECK_NOTHROW(check_phrase("größer"));
}

TEST_CASE("With a phrase, a submission's seeds follow from it, and no episode is left out") {
  const Scratch place;
  const ResultsFolder folder(place.path("mine"));
  make_submission(folder, kPhrase, [](int episode) {
    return seed_of_phrase("the first headline of Sunday", "beamfall", 1, episode);
  });
  const Verified good = of_submission(folder);
  INFO(good.findings);
  REQUIRE(good.verdict.confirmed == 3);
  REQUIRE(good.verdict.wrong == 0);
  const auto refused = [&](const std::string& sentence) {
    const Verified found = of_submission(folder);
    CHECK(found.verdict.wrong >= 1);
    CHECK_THAT(found.findings, Catch::Contains(sentence));
  };
  // Gives an episode of another seed to a row.
  const auto replay_with = [&](std::size_t line, std::uint32_t seed) {
    reseal(folder, line, [&](EpisodeLog& log) {
      const EpisodeOrigin origin = log.origin;
      log = random_log(sticky_episodes(), seed);
      log.origin = origin;
    });
  };

  SECTION("a seed that was picked, with an episode that fits it") {
    replay_with(1, 12345);
    refused(
        "results.csv:3 (mine-1, episode 2): not confirmed: environment_seed is '12345'; the phrase gives '");
  }
  SECTION("the seed of another episode") {
    replay_with(1, seed_of_phrase("the first headline of Sunday", "beamfall", 1, 3));
    refused("(mine-1, episode 2): not confirmed: environment_seed is '");
  }
  SECTION("another phrase") {
    write(folder.root() + "/agent.toml", agent_with("phrase", "phrase = \"another\""));
    CHECK(of_submission(folder).verdict.confirmed == 0);
  }
  SECTION("an episode that was left out") {
    std::vector<ResultRow> rows = rows_of(contents(folder.results()));
    write(folder.results(), line_of(kResultColumns) + line_of(rows[0]) + line_of(rows[2]));
    fs::remove(folder.log("mine-1", "2"));
    refused("results.csv: mine-1 has 2 episodes, and the last is 3; with a phrase, none is left out");
  }
  SECTION("a second unit with the same seeds") {
    std::vector<ResultRow> rows = rows_of(contents(folder.results()));
    fs::create_directories(folder.logs("mine-2"));
    EpisodeLog log = log_of("1.episode", contents(folder.log("mine-1", "1")));
    log.origin.unit = "mine-2";
    write(folder.log("mine-2", "1"), bytes_of(log));
    write(folder.results(), contents(folder.results()) + line_of(row_of(log, sha256_of(bytes_of(log)))));
    refused("trial 1 of beamfall is the unit mine-1; with a phrase, no other unit has its seeds");
  }
  SECTION("numbers that do not count from 1") {
    reseal(folder, 0, [](EpisodeLog& log) { log.origin.trial = 0; });
    CHECK(of_submission(folder).verdict.wrong >= 1);
    write(folder.results(), altered_field(contents(folder.results()), 1, 4, "01"));
    refused("trial is '01' and episode is '2'; with a phrase, both count from 1");
  }
  SECTION("a phrase that cannot be one") {
    write(folder.root() + "/agent.toml", agent_with("phrase", "phrase = \"\""));
    CHECK_THROWS_WITH(of_submission(folder),
                      Catch::Contains("agent.toml: phrase is ''; expected 1 to 1000 bytes, without "));
  }
}
