#include "recording/atomic_file.hpp"

#include <sys/stat.h>

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
  const std::string part = folder.write(".table.csv.part", "half a table, longer than the new one");
  std::filesystem::permissions(part, std::filesystem::perms(01644));  // as replace_file() makes it
  replace_file(folder.path("table.csv"), "new", Durable::kLater);
  CHECK(contents(folder.path("table.csv")) == "new");
  CHECK(std::filesystem::status(folder.path("table.csv")).permissions() == std::filesystem::perms(0644));
  CHECK(!std::filesystem::exists(part));
}

TEST_CASE("A file is replaced without regard to files of other names") {
  const Scratch folder;
  const std::string mine = folder.write("mine", "precious");
  folder.write(".table.csv.part", "a user's own");
  std::filesystem::create_symlink("mine", folder.path(".other.csv.part"));
  REQUIRE(::mkfifo(folder.path(".third.csv.part").c_str(), 0600) == 0);
  for (const std::string name : {"table.csv", "other.csv", "third.csv"}) {
    replace_file(folder.path(name), "new", Durable::kLater);
    CHECK(contents(folder.path(name)) == "new");
  }
  CHECK(contents(mine) == "precious");
  CHECK(contents(folder.path(".table.csv.part")) == "a user's own");
}

TEST_CASE("A file that replaces another has the mode that new files have") {
  const Scratch folder;
  const mode_t before = ::umask(0077);
  replace_file(folder.path("private.csv"), "new", Durable::kLater);
  ::umask(before);
  CHECK(std::filesystem::status(folder.path("private.csv")).permissions() == std::filesystem::perms(0600));
}

TEST_CASE("A link stays, and the file that it names is replaced") {
  const Scratch folder;
  folder.write("old.csv", "old");
  std::filesystem::create_symlink("old.csv", folder.path("link.csv"));
  std::filesystem::create_symlink("link.csv", folder.path("second.csv"));
  std::filesystem::create_symlink("new.csv", folder.path("broken.csv"));
  for (const std::string name : {"second.csv", "broken.csv"}) {
    replace_file(folder.path(name), "new", Durable::kNow);
    CHECK(std::filesystem::is_symlink(folder.path(name)));
  }
  CHECK(contents(folder.path("old.csv")) == "new");
  CHECK(contents(folder.path("new.csv")) == "new");
}

TEST_CASE("A file that cannot be written stays as it was") {
  const Scratch folder;
  const std::string path = folder.path("table.csv");
  std::filesystem::create_directory(path);
  CHECK_THROWS_WITH(replace_file(path, "new", Durable::kLater),
                    Catch::StartsWith("cannot replace table.csv: "));
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path("")), {}) == 1);
  CHECK_THROWS_WITH(replace_file(folder.path("none/table.csv"), "new", Durable::kLater),
                    Catch::StartsWith("cannot make table.csv: "));
}
