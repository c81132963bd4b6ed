// Who may read the files that the program makes, and what it does about links and pipes.
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <cerrno>
#include <filesystem>

#include "system/output_file.hpp"
#include "system/regular_file.hpp"
#include "tests/games/scratch.hpp"

namespace fs = std::filesystem;
using namespace racebeam;

namespace {

unsigned mode_of(const std::string& path) { return static_cast<unsigned>(fs::status(path).permissions()); }

}  // namespace

TEST_CASE("The readers of a file are its owner, or everyone") {
  const Scratch folder;
  std::string path = folder.path("a.XXXXXX");
  const int file = make_temporary_file(path);
  CHECK(mode_of(path) == 0600);
  CHECK_FALSE(all_may_read(path));
  CHECK(set_readers(file, Readers::kEveryone));
  CHECK(mode_of(path) == 0644);
  CHECK(all_may_read(path));
  CHECK(set_readers(file, Readers::kNobody));
  CHECK(mode_of(path) == 0600);
  close_file(file);
  CHECK_FALSE(set_readers(-1, Readers::kNobody));
  CHECK_FALSE(all_may_read(folder.path("none")));
}

TEST_CASE("A temporary folder belongs to its owner until it is opened to all") {
  const Scratch folder;
  std::string path = folder.path("a.XXXXXX");
  REQUIRE(make_temporary_folder(path));
  CHECK(mode_of(path) == 0700);
  open_folder_to_all(path);
  CHECK(mode_of(path) == 0755);
}

TEST_CASE("A file that is not marked any more has the mode of new files") {
  const Scratch folder;
  const int file = make_marked_file(folder.path("a"));
  REQUIRE(file >= 0);
  unmark(file);
  close_file(file);
  CHECK(mode_of(folder.path("a")) == 0644);
}

TEST_CASE("Own files are not opened through a link, and a link is not made to a marked file") {
  const Scratch folder;
  const std::string target = folder.write("target", "text"), link = folder.path("link");
  fs::create_symlink("target", link);
  CHECK(open_to_append(link) == -1);
  CHECK(errno == ELOOP);
  CHECK(open_own_file(link) == -1);
  CHECK(make_marked_file(link) == -1);
  CHECK(make_file(link) == -1);
  CHECK(fs::file_size(target) == 4);
  CHECK(mark_of(link) != mark_of(target));
  CHECK_FALSE(mark_of(link).is_regular);
  CHECK(all_may_read(link));
}

TEST_CASE("The mark of a pipe does not change with what is written there") {
  const Scratch folder;
  const std::string path = folder.path("pipe");
  REQUIRE(::mkfifo(path.c_str(), 0600) == 0);
  const FileMark mark = mark_of(path);
  CHECK(mark.number != 0);
  CHECK((mark.seconds == 0 && mark.nanoseconds == 0 && !mark.is_regular));
}
