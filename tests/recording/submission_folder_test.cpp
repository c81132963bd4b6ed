#include "recording/submission_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <future>
#include <string>
#include <vector>

#include "tests/games/scratch.hpp"

using namespace racebeam;

namespace {

// What the constructor refuses; empty: nothing. The folder takes a unit of this number.
std::string refusal_of(const std::string& path, int trial) {
  DiskBudget budget(std::size_t{1} << 20);
  SubmissionOrder order;
  order.path = path;
  order.unit = "beamfall-agent-" + std::to_string(trial);
  try {
    const SubmissionFolder folder(std::move(order), budget);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("Several can begin a submission at the same time") {
  constexpr int kPrograms = 4;
  const Scratch place;
  for (const char* const name : {"one", "two", "three"}) {
    std::vector<std::future<std::string>> refusals;
    for (int trial = 1; trial <= kPrograms; ++trial)
      refusals.push_back(std::async(std::launch::async, refusal_of, place.path(name), trial));
    for (auto& refusal : refusals) CHECK(refusal.get() == "");
  }
  CHECK(std::distance(std::filesystem::directory_iterator(place.path("")), {}) == 3);
}

TEST_CASE("A refused unit leaves the submission that others have begun") {
  const Scratch place;
  DiskBudget budget(std::size_t{1} << 20);
  SubmissionOrder order;
  order.path = place.path("mine");
  order.unit = "beamfall-agent-1";
  const SubmissionFolder folder(order, budget);
  CHECK(refusal_of(order.path, 1) ==
        "mine has the unit beamfall-agent-1 already; another trial= makes another");
  CHECK(std::filesystem::exists(order.path + "/logs/beamfall-agent-1"));
  CHECK(std::filesystem::exists(order.path + "/agent.toml"));
}

TEST_CASE("A program that keeps the lock of the table does not keep a recorder for long") {
  const Scratch place;
  CHECK(refusal_of(place.path("mine"), 1) == "");
  const int table = ::open(place.path("mine/results.csv").c_str(), O_RDONLY | O_CLOEXEC);
  REQUIRE(::flock(table, LOCK_EX) == 0);
  CHECK(refusal_of(place.path("mine"), 2) == "cannot lock results.csv: Resource temporarily unavailable");
  auto waiting = std::async(std::launch::async, refusal_of, place.path("mine"), 3);
  ::close(table);
  CHECK(waiting.get() == "");
}
