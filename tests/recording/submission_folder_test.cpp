#include "recording/submission_folder.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <future>
#include <string>
#include <vector>

#include "environment/settings/setting_tables.hpp"
#include "recording/result_row.hpp"
#include "recording/sha256.hpp"
#include "tests/games/scratch.hpp"
#include "tests/recording/sample_log.hpp"

using namespace racebeam;

namespace {

constexpr std::size_t kMuch = std::size_t{1} << 20;

// An order for the unit of this number.
SubmissionOrder order_of(const std::string& path, int trial) {
  SubmissionOrder order;
  order.path = path;
  order.unit = "beamfall-agent-" + std::to_string(trial);
  order.settings = settings_without_seed(test::sample_log().settings);
  return order;
}

// What the constructor refuses; empty: nothing.
std::string refusal_of(SubmissionOrder order) {
  DiskBudget budget(kMuch);
  try {
    const SubmissionFolder folder(std::move(order), budget);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

std::string refusal_of_unit(const std::string& path, int trial) { return refusal_of(order_of(path, trial)); }

std::string contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

TEST_CASE("A plain name has letters, digits and three signs, and begins with one of the former") {
  for (const char* name : {"a", "z", "A", "Z", "0", "9", "aZ0_.-", "12345678"}) {
    INFO(name);
    CHECK(is_plain_name(name, 8));
  }
  for (const char* name :
       {"", "_a", ".a", "-a", "a b", "a/b", "a:b", "a@b", "a[b", "a`b", "a{b", "123456789"}) {
    INFO(name);
    CHECK_FALSE(is_plain_name(name, 8));
  }
}

TEST_CASE("The preset of a log is the evaluation preset whose settings it has") {
  for (const description::EvaluationPreset& preset : description::kEvaluationPresets) {
    const std::string settings = "seed=1 " + std::string(preset.words) + " rules=ale-0.12 life_loss_ends=0";
    CHECK(preset_of(settings) == preset.name);
    CHECK(preset_of(settings.substr(0, settings.rfind(' '))) == "other");
    CHECK(preset_of(std::string(preset.words)) == "other");
  }
  CHECK(preset_of("") == "other");
}

TEST_CASE("A submission has an agent.toml, the rows of its logs, and the logs") {
  const Scratch place;
  DiskBudget budget(kMuch);
  const EpisodeLog log = test::sample_log();
  SubmissionOrder order = order_of(place.path("mine"), 2);
  order.about.agent = "mine";
  order.about.version = "2";
  order.about.training_frames = 7;
  order.about.phrase = "words";
  {
    SubmissionFolder folder(order, budget);
    folder.add(log);
  }
  CHECK(contents(place.path("mine/agent.toml")) ==
        "agent = \"mine\"\nversion = \"2\"\npreset = \"other\"\ntraining_frames = 7\nphrase = \"words\"\n");
  const std::string bytes = contents(place.path("mine/logs/beamfall-agent-2/3.episode"));
  CHECK(bytes == bytes_of(log));
  CHECK(contents(place.path("mine/results.csv")) ==
        line_of(kResultColumns) + line_of(row_of(log, sha256_of(bytes))));
  CHECK(budget.taken() >= bytes.size() + 4096);
}

TEST_CASE("A submission is continued only with the same agent and settings") {
  const Scratch place;
  DiskBudget budget(kMuch);
  const SubmissionOrder first = order_of(place.path("mine"), 2);
  SubmissionFolder(first, budget).add(test::sample_log());
  CHECK(refusal_of_unit(first.path, 3).empty());
  SubmissionOrder other = order_of(first.path, 3);
  other.about.version = "other";
  CHECK(refusal_of(other) == "mine has another agent.toml; choose another name, or the same words");
  other = order_of(first.path, 3);
  other.settings = "frame_skip=5";
  CHECK(refusal_of(other) ==
        "the logs of mine have the settings 'frame_skip=4 sticky=0.25', not 'frame_skip=5'; choose another "
        "name");
  std::filesystem::create_directory(place.path("empty"));
  CHECK(refusal_of_unit(place.path("empty"), 1) ==
        "empty exists, and has no agent.toml; choose another name");
  std::filesystem::create_directory_symlink("mine", place.path("link"));
  CHECK(refusal_of_unit(place.path("link"), 3) == "link exists, and has no agent.toml; choose another name");
  place.write("mine/results.csv", "");
  CHECK(refusal_of_unit(first.path, 3).empty());
  CHECK(contents(place.path("mine/results.csv")) == line_of(kResultColumns));
}

TEST_CASE("A unit without a log leaves nothing, and one with a log stays") {
  const Scratch place;
  DiskBudget budget(kMuch);
  const SubmissionOrder order = order_of(place.path("mine"), 2);
  const std::string unit = place.path("mine/logs/beamfall-agent-2");
  for (int time = 0; time < 2; ++time) {
    const SubmissionFolder folder(order, budget);
    CHECK(std::filesystem::exists(unit));
  }
  CHECK_FALSE(std::filesystem::exists(unit));
  SubmissionFolder(order, budget).add(test::sample_log());
  CHECK(std::filesystem::exists(unit));
  CHECK(refusal_of(order) == "mine has the unit beamfall-agent-2 already; another trial= makes another");
}

TEST_CASE("A log is removed if its row cannot be written, or if it exceeds the budget") {
  const Scratch place;
  DiskBudget budget(kMuch), small(4096 + 400);
  SubmissionFolder folder(order_of(place.path("mine"), 2), budget);
  const std::string table = place.path("mine/results.csv");
  std::filesystem::remove(table);
  std::filesystem::create_directory(table);
  CHECK_THROWS_WITH(folder.add(test::sample_log()), Catch::StartsWith("cannot open results.csv: "));
  CHECK(std::filesystem::is_empty(place.path("mine/logs/beamfall-agent-2")));
  SubmissionFolder full(order_of(place.path("other"), 2), small);
  CHECK_THROWS_AS(full.add(test::sample_log()), BudgetSpent);
  CHECK(std::filesystem::is_empty(place.path("other/logs/beamfall-agent-2")));
  CHECK(contents(place.path("other/results.csv")) == line_of(kResultColumns));
}

TEST_CASE("Of a row that the disk takes only a part of, nothing stays") {
  const Scratch place;
  DiskBudget budget(kMuch);
  SubmissionFolder folder(order_of(place.path("mine"), 2), budget);
  const std::string table = line_of(kResultColumns) + std::string(10'000, 'x');  // larger than the log
  place.write("mine/results.csv", table);
  rlimit before{};
  REQUIRE(::getrlimit(RLIMIT_FSIZE, &before) == 0);
  const rlimit most{table.size() + 10, before.rlim_max};
  const auto handler = ::signal(SIGXFSZ, SIG_IGN);
  REQUIRE(::setrlimit(RLIMIT_FSIZE, &most) == 0);
  CHECK_THROWS_WITH(folder.add(test::sample_log()), "cannot write results.csv: File too large");
  REQUIRE(::setrlimit(RLIMIT_FSIZE, &before) == 0);
  ::signal(SIGXFSZ, handler);
  CHECK((contents(place.path("mine/results.csv")) == table));
  CHECK(std::filesystem::is_empty(place.path("mine/logs/beamfall-agent-2")));
}

TEST_CASE("Several can begin a submission at the same time") {
  constexpr int kPrograms = 4;
  const Scratch place;
  for (const char* const name : {"one", "two", "three"}) {
    std::vector<std::future<std::string>> refusals;
    for (int trial = 1; trial <= kPrograms; ++trial)
      refusals.push_back(std::async(std::launch::async, refusal_of_unit, place.path(name), trial));
    for (auto& refusal : refusals) CHECK(refusal.get() == "");
  }
  CHECK(std::distance(std::filesystem::directory_iterator(place.path("")), {}) == 3);
}

TEST_CASE("A refused unit leaves the submission that others have begun") {
  const Scratch place;
  DiskBudget budget(kMuch);
  const SubmissionOrder order = order_of(place.path("mine"), 1);
  const SubmissionFolder folder(order, budget);
  CHECK(refusal_of(order) == "mine has the unit beamfall-agent-1 already; another trial= makes another");
  CHECK(std::filesystem::exists(order.path + "/logs/beamfall-agent-1"));
  CHECK(std::filesystem::exists(order.path + "/agent.toml"));
}

TEST_CASE("A program that keeps the lock of the table does not keep a recorder for long") {
  const Scratch place;
  CHECK(refusal_of_unit(place.path("mine"), 1) == "");
  const int table = ::open(place.path("mine/results.csv").c_str(), O_RDONLY | O_CLOEXEC);
  REQUIRE(::flock(table, LOCK_EX) == 0);
  CHECK(refusal_of_unit(place.path("mine"), 2) ==
        "cannot lock results.csv: Resource temporarily unavailable");
  auto waiting = std::async(std::launch::async, refusal_of_unit, place.path("mine"), 3);
  ::close(table);
  CHECK(waiting.get() == "");
}
