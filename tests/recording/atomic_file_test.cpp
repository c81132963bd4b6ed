#include "recording/atomic_file.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/games/scratch.hpp"

using namespace racebeam;

namespace {

std::string contents(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

}  // namespace

TEST_CASE("A file is replaced, and nothing else is left beside it") {
  const Scratch folder;
  const std::string path = folder.path("table.csv");
  for (const Durable durable : {Durable::kLater, Durable::kNow}) {
    for (const std::string& bytes :
         {std::string("a long first version"), std::string("short"), std::string()}) {
      replace_file(path, bytes, durable);
      CHECK(contents(path) == bytes);
    }
  }
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path("")), {}) == 1);
}

TEST_CASE("What a kill left behind is overwritten") {
  const Scratch folder;
  folder.write(".table.csv.part", "half a table, longer than the new one");
  replace_file(folder.path("table.csv"), "new", Durable::kLater);
  CHECK(contents(folder.path("table.csv")) == "new");
  CHECK(!std::filesystem::exists(folder.path(".table.csv.part")));
}

TEST_CASE("A file that cannot be written stays as it was") {
  const Scratch folder;
  const std::string path = folder.write("table.csv", "old");
  std::filesystem::create_directory(folder.path(".table.csv.part"));
  CHECK_THROWS_WITH(replace_file(path, "new", Durable::kLater), Catch::StartsWith("cannot make table.csv: "));
  CHECK(contents(path) == "old");
  CHECK_THROWS_AS(replace_file(folder.path("none/table.csv"), "new", Durable::kLater), std::runtime_error);
}
