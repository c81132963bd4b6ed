#include "agents/experiment/experiment.hpp"

#include <array>
#include <atomic>
#include <catch2/catch.hpp>
#include <map>
#include <mutex>
#include <optional>
#include <thread>

#include "agents/experiment/cost.hpp"
#include "agents/experiment/trial.hpp"
#include "agents/features/game_facts.hpp"
#include "recording/sealed_file.hpp"
#include "system/file_lock.hpp"
#include "system/invalid_input.hpp"
#include "tests/agents/experiment/verified.hpp"

using namespace racebeam;
using namespace racebeam::test;

namespace {

namespace fs = std::filesystem;

// The contents of all files but the times, by their paths.
std::map<std::string, std::string> files_of(const ResultsFolder& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder.root())) {
    const std::string path = fs::relative(entry.path(), folder.root()).string();
    if (!entry.is_directory() && path.find("times") == std::string::npos)
      files[path] = contents(entry.path().string());
  }
  return files;
}

// A checkpoint of Random, as trial.cpp writes it.
std::string random_checkpoint(std::int32_t trained, std::int32_t evaluated, std::int64_t frames) {
  StateWriter out;
  for (const std::int32_t episodes : {trained, evaluated}) out.put(episodes);
  out.put(std::array<std::int64_t, 6>{0, frames});
  for (const std::string_view table : {"", ""}) out.put(table);
  out.put(Random(1));
  return seal({.what = "checkpoint", .magic = "RBCHECKP", .version = 3, .most = 1000, .level = 1},
              out.bytes());
}

// Their searches draw numbers, from one episode to the next.
constexpr auto kPlanners = R"(games = ["beamfall"]
agents = ["uct", "full_tree", "iw1"]
[agent.uct]
trials = 1
evaluation_episodes = 4
simulations = 40
[agent.full_tree]
trials = 1
evaluation_episodes = 4
frames = 600
[agent.iw1]
trials = 1
evaluation_episodes = 4
frames = 600
)";

}  // namespace

TEST_CASE(
    "Results are the same on one thread and two, by either processor, in shards and after interruptions") {
  const Scratch place;
  const Plan plan = bound_plan(kPlan);
  const ResultsFolder whole(place.path("whole")), parts(place.path("parts"));
  run(plan, whole);
  run(plan, parts, {.threads = 2, .shard = 2, .shards = 3, .cpu = CpuKind::kInterpreter});
  run(plan, parts, {.threads = 1, .shard = 1, .shards = 3});
  CHECK(contents(parts.results()).size() < contents(whole.results()).size());
  run(plan, parts, {.threads = 2});
  CHECK(files_of(whole) == files_of(parts));
  CHECK(!fs::exists(parts.work()));
}

TEST_CASE("A trial goes on from its checkpoint as if nothing had happened") {
  const Scratch place;
  const Plan plan = bound_plan(GENERATE(
      std::string(kPlan), "environment = \"max_episode_frames=200 sticky=0.25\"\n" + std::string(kPlanners),
      "environment = \"max_episode_frames=200\"\n" + std::string(kPlanners)));
  const ResultsFolder whole(place.path("whole")), parts(place.path("parts"));
  run(plan, whole);
  const std::vector<Unit> units = units_of(plan);
  const Images images;
  for (const std::string& path : {parts.units(), parts.logs(), parts.facts(), parts.work()})
    fs::create_directories(path);
  write(parts.plan(), text_of(plan));
  for (const Unit& unit : units) {
    const Cartridge& cartridge = *images.find("beamfall");
    for (bool finished = false; !finished;) {
      GameFacts facts(cartridge, sample_settings(plan, *unit.game), parts.facts());
      Trial trial(plan, unit, parts, cartridge, &facts, CpuKind::kAuto);
      finished =
          trial.run(std::chrono::milliseconds(0), [episodes = 0]() mutable { return episodes++ == 1; });
    }
  }
  run(plan, parts);
  CHECK(files_of(whole) == files_of(parts));
}

TEST_CASE("The role of each agent is reported once") {
  const Scratch place;
  const ResultsFolder folder(place.path("results"));
  run(bound_plan("games = [\"beamfall\", \"updraft\"]\nagents = [\"uct\", \"random\", \"basic\"]\n"
                 "trials = 2\ntraining_episodes = 1\nevaluation_episodes = 1\nbackground_screens = 300\n"
                 "environment = \"max_episode_frames=50\"\n[agent.uct]\nsimulations = 2\n"),
      folder);
  CHECK(contents(folder.agents()) == "agent,role\nuct,planner\nrandom,baseline\nbasic,learner\n");
}

TEST_CASE("Progress counts the units that another process finishes") {
  const Scratch place;
  const ResultsFolder folder(place.path("results"));
  const Plan plan = bound_plan(
      "games = [\"beamfall\"]\nagents = [\"random\"]\nenvironment = \"max_episode_frames=50\"\n"
      "[agent.random]\ntrials = 6\nevaluation_episodes = 1\n");
  std::vector<std::size_t> counts;
  run_experiment(plan, Images(), folder, {}, [&](const Progress& at) {
    counts.push_back(at.finished);
    if (counts.size() == 1) run(plan, folder, {.shard = 2, .shards = 2});  // units 2, 4 and 6
    CHECK(at.all == 6);
  });
  CHECK(counts == std::vector<std::size_t>{1, 5, 6});
}

TEST_CASE("A unit that another process runs is named, and the rest is done") {
  const Scratch place;
  const ResultsFolder folder(place.path("results"));
  const Plan plan = bound_plan(kPlan);
  fs::create_directories(folder.work());
  {
    const FileLock other(folder.lock("beamfall-random-1"));
    CHECK_THROWS_WITH(run(plan, folder),
                      Catch::StartsWith("beamfall-random-1 is being run by another process"));
  }
  CHECK(rows_of(contents(folder.results())).size() == 38);
  run(plan, folder);
  CHECK(verified(folder).verdict.confirmed == 40);
}

TEST_CASE("A checkpoint with counts that its trial cannot have is refused") {
  const Scratch place;
  const ResultsFolder folder(place.path("results"));
  const Plan plan = bound_plan(kPlan);
  fs::create_directories(folder.work());
  for (const auto& [trained, evaluated, frames] :
       {std::tuple{-1, 0, 0}, {0, -1, 0}, {0, 1000, 0}, {1000, 0, 0}, {0, 0, -1}}) {
    write(folder.checkpoint("beamfall-random-1"), random_checkpoint(trained, evaluated, frames));
    CHECK_THROWS_WITH(run(plan, folder),
                      Catch::Contains("its counts of episodes, frames and times are invalid"));
  }
  write(folder.checkpoint("beamfall-random-1"), random_checkpoint(0, 0, 0));
  CHECK_NOTHROW(run(plan, folder));
}

TEST_CASE("A checkpoint of another unit is refused") {
  const Scratch place;
  const ResultsFolder folder(place.path("results"));
  const Plan plan = bound_plan(
      "games = [\"beamfall\"]\nagents = [\"random\"]\nenvironment = \"max_episode_frames=200\"\n"
      "[agent.random]\ntrials = 2\nevaluation_episodes = 3\n");
  const std::vector<Unit> units = units_of(plan);
  fs::create_directories(folder.work());
  const Images images;
  Trial trial(plan, units[0], folder, *images.find("beamfall"), nullptr, CpuKind::kAuto);
  trial.run(std::chrono::milliseconds(0), [episodes = 0]() mutable { return episodes++ == 1; });
  fs::copy_file(folder.checkpoint(units[0].name), folder.checkpoint(units[1].name));
  fs::remove_all(folder.logs());  // an experiment begins in a folder without logs
  CHECK_THROWS_WITH(run(plan, folder),
                    Catch::Contains("its tables are not those of 0 training and 1 evaluation episodes of "
                                    "beamfall-random-2; another unit or another version of the program"));
  fs::remove(folder.checkpoint(units[1].name));
  CHECK_NOTHROW(run(plan, folder));
}

TEST_CASE("A damaged checkpoint, and a background of another game, are refused") {
  const Scratch place;
  const ResultsFolder folder(place.path("results"));
  const Plan plan = bound_plan(kPlan);
  fs::create_directories(folder.work());
  write(folder.checkpoint("beamfall-random-1"), "RBCHECKP");
  CHECK_THROWS_WITH(run(plan, folder),
                    Catch::StartsWith("checkpoint " + folder.checkpoint("beamfall-random-1") + ": "));
  fs::remove(folder.checkpoint("beamfall-random-1"));
  const Cartridge other{load_image("builtin:updraft"), find_game("updraft")};
  write(folder.facts() + "/beamfall.background", bytes_of(Background{}, other, {1, 300, 300, plan.play}));
  CHECK_THROWS_WITH(run(plan, folder),
                    Catch::EndsWith("beamfall.background: game is 'updraft'; expected 'beamfall'"));
}

TEST_CASE("Files of games that do not fit the plan are refused before anything is written") {
  const Scratch place;
  const ResultsFolder folder(place.path("results"));
  Plan plan = bound_plan(kPlan);
  fs::create_directories(folder.facts());
  const SampleSettings csv{plan.seed, 300, 300, plan.play, std::string(64, 'a')};
  write(folder.facts() + "/beamfall.background", bytes_of(Background{}, beamfall(), csv));
  CHECK_THROWS_WITH(run(plan, folder), Catch::Contains("beamfall.background: csv is 'aaaa") &&
                                           Catch::EndsWith("aaaa...'; expected none"));
  CHECK(files_of(folder).size() == 1);
  CHECK(!fs::exists(folder.units()));

  plan.games[0].background_csv = std::string(64, 'b');
  CHECK_THROWS_WITH(run(plan, folder), Catch::Contains("beamfall.background: csv is 'aaaa") &&
                                           Catch::Contains("...'; expected 'bbbb"));
  fs::remove(folder.facts() + "/beamfall.background");
  CHECK_THROWS_WITH(run(plan, folder), Catch::Contains("beamfall.background: no such file; racebeam "
                                                       "background beamfall --csv FILE --into "));
  CHECK(!fs::exists(folder.plan()));

  plan.games[0].background_csv = csv.background_csv;
  write(folder.facts() + "/beamfall.background", bytes_of(Background{}, beamfall(), csv));
  run(plan, folder);
  CHECK_THAT(contents(folder.plan()), Catch::Contains("[backgrounds]\nbeamfall = \"" + csv.background_csv));
  CHECK(verified(folder).verdict.confirmed == 40);
}

TEST_CASE("What is finished is in the tables, even if a unit fails") {
  const Scratch place;
  const ResultsFolder folder(place.path("results"));
  fs::create_directories(folder.work());
  write(folder.checkpoint("beamfall-basic-1"), "RBCHECKP");
  CHECK_THROWS_WITH(run(bound_plan(kPlan), folder),
                    Catch::StartsWith("checkpoint " + folder.checkpoint("beamfall-basic-1")));
  CHECK(rows_of(contents(folder.results())).size() == 38);
}

TEST_CASE("What ends a run early is handed on, and what is finished is in the tables") {
  struct Ended {};
  const Scratch place;
  const ResultsFolder whole(place.path("whole")), folder(place.path("results"));
  const Plan plan = bound_plan(kPlan);
  run(plan, whole);
  std::atomic<int> finished = 0;
  ExperimentSettings settings{.threads = 2};
  settings.check = [&] {
    if (finished >= 5) throw Ended();
  };
  CHECK_THROWS_AS(run_experiment(plan, Images(), folder, settings,
                                 [&](const Progress& at) { finished += at.unit_finished; }),
                  Ended);
  const std::size_t rows = rows_of(contents(folder.results())).size();
  CHECK(rows >= 10);
  CHECK(rows < 40);
  run(plan, folder);
  CHECK(files_of(whole) == files_of(folder));
}

TEST_CASE("A folder with files of its user is refused, and its files stay") {
  for (const std::string name :
       {"results.csv", "curves.csv", "times.csv", "agents.csv", "units/x", "logs/x", "work/thesis"}) {
    INFO(name);
    const Scratch place;
    const ResultsFolder folder(place.path("results"));
    const fs::path file = folder.root() + '/' + name;
    fs::create_directories(file.parent_path());
    write(file.string(), "mine");
    CHECK_THROWS_WITH(run(bound_plan(kPlan), folder), Catch::Contains("has no plan.toml, but ") &&
                                                          Catch::EndsWith("; choose another folder"));
    CHECK(contents(file.string()) == "mine");
    CHECK_FALSE(fs::exists(folder.plan()));
  }
}

TEST_CASE("A file of another program in the folder of work stays") {
  const Scratch place;
  const ResultsFolder folder(place.path("results"));
  const Plan plan = bound_plan(kPlan);
  run(plan, folder);
  CHECK_FALSE(fs::exists(folder.work()));
  fs::create_directories(folder.work());
  write(folder.work() + "/notes", "mine");
  run(plan, folder);
  CHECK(contents(folder.work() + "/notes") == "mine");
}

TEST_CASE("Results whose units are gone are refused, and stay") {
  const Scratch place;
  const ResultsFolder folder(place.path("results"));
  const Plan plan = bound_plan(kPlan);
  run(plan, folder);
  const std::string before = contents(folder.results());
  fs::remove(folder.unit("beamfall-basic-1", "results"));
  CHECK_THROWS_WITH(run(plan, folder),
                    Catch::Contains(" has 40 rows, and ") && Catch::Contains(" has 38 of them"));
  CHECK(contents(folder.results()) == before);
}

TEST_CASE("A folder that cannot be made is named") {
  const Scratch place;
  write(place.path("file"), "");
  CHECK_THROWS_WITH(run(bound_plan(kPlan), ResultsFolder(place.path("file"))),
                    "cannot make the folder " + place.path("file") + ": Not a directory");
  fs::create_symlink("loop", place.path("loop"));
  CHECK_THROWS_WITH(run(bound_plan(kPlan), ResultsFolder(place.path("loop"))),
                    Catch::StartsWith("cannot make the folder " + place.path("loop") + ": "));
}

TEST_CASE("A unit that another process finishes meanwhile does not fail") {
  const Scratch place;
  const ResultsFolder whole(place.path("whole")), folder(place.path("results"));
  const Plan plan = bound_plan(kPlan);
  run(plan, whole);
  const std::string unit = "beamfall-random-1";
  fs::create_directories(folder.work());
  auto lock = std::make_optional<FileLock>(folder.lock(unit));
  CHECK_NOTHROW(run_experiment(plan, Images(), folder, {}, [&](const Progress& at) {
    if (at.finished != 1) return;
    fs::copy(whole.logs(unit), folder.logs(unit));
    for (const std::string table : {"times", "curves", "results"})
      fs::copy(whole.unit(unit, table), folder.unit(unit, table));
    lock.reset();
  }));
  CHECK(files_of(whole) == files_of(folder));
  CHECK(!fs::exists(folder.work()));
}

TEST_CASE("A unit whose process was killed meanwhile is run by the other") {
  const Scratch place;
  const ResultsFolder folder(place.path("results"));
  fs::create_directories(folder.work());
  auto lock = std::make_optional<FileLock>(folder.lock("beamfall-random-1"));
  CHECK_NOTHROW(
      run_experiment(bound_plan(kPlan), Images(), folder, {}, [&](const Progress&) { lock.reset(); }));
  CHECK(verified(folder).verdict.confirmed == 40);
}

// Each of them removes the folder of work, in which others have begun to wait for the plan's lock.
TEST_CASE("Many processes at once on a finished folder leave it as it is") {
  const Scratch place;
  const ResultsFolder folder(place.path("results"));
  const Plan plan = bound_plan(
      "games = [\"beamfall\"]\nagents = [\"random\"]\nevaluation_episodes = 1\n"
      "environment = \"max_episode_frames=100\"\n");
  run(plan, folder);
  const auto before = files_of(folder);
  std::mutex mutex;
  std::string failures;
  std::vector<std::jthread> processes(12);
  for (std::jthread& process : processes)
    process = std::jthread([&] {
      for (int time = 0; time < 20; ++time) try {
          run(plan, folder);
        } catch (const std::exception& error) {
          const std::lock_guard lock(mutex);
          (failures += error.what()) += '\n';
        }
    });
  processes.clear();
  CHECK(failures == "");
  CHECK(files_of(folder) == before);
  CHECK(!fs::exists(folder.work()));
}

TEST_CASE("Progress is reported within a unit, and weighs what is left by its cost") {
  const Scratch place;
  std::vector<Progress> reports;
  const Plan plan = bound_plan(kPlan);
  run_experiment(plan, Images(), ResultsFolder(place.path("results")),
                 {.reports = std::chrono::milliseconds(1)},
                 [&](const Progress& at) { reports.push_back(at); });
  const auto within = std::ranges::find_if(
      reports, [](const Progress& at) { return !at.unit_finished && at.unit == "beamfall-basic-1"; });
  REQUIRE(within != reports.end());
  CHECK(within->finished == 19);
  CHECK(within->decisions > 0);
  const auto last_baseline =
      std::ranges::find_if(reports, [](const Progress& at) { return at.unit_finished && at.finished == 19; });
  REQUIRE(last_baseline != reports.end());
  const auto seconds = [&](std::size_t agent) {
    return seconds_of_trial(plan.agents[agent], PlayRates().of(plan, plan.games[0], plan.agents[agent]));
  };
  CHECK(last_baseline->left / last_baseline->elapsed ==
        Approx(seconds(2) / (seconds(0) + 18 * seconds(1))));  // Basic's one unit; Random, 18 of Perturb
  CHECK(reports.back().left.count() == 0);
}
