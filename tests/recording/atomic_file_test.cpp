#include "recording/atomic_file.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/games/scratch.hpp"
#include "tests/support/skip.hpp"

using namespace racebeam;

namespace {

std::string contents(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

int mode_of(const std::string& path) { return static_cast<int>(std::filesystem::status(path).permissions()); }

std::ptrdiff_t files_in(const Scratch& folder) {
  return std::distance(std::filesystem::directory_iterator(folder.path("")), {});
}

// While it exists, files cannot grow beyond this many bytes: as on a full disk.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int);
};

// While it exists, the process has no standard input, so that the next file has the descriptor 0.
class NoStandardInput {
 public:
  NoStandardInput() : before_(::dup(0)) { ::close(0); }
  ~NoStandardInput() {
    ::dup2(before_, 0);
    ::close(before_);
  }
  NoStandardInput(const NoStandardInput&) = delete;
  NoStandardInput& operator=(const NoStandardInput&) = delete;

 private:
  int before_;
};

std::ptrdiff_t open_descriptors() {
  return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {});
}

std::span<const std::uint8_t> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
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
                    Catch::StartsWith("cannot replace " + path + ": "));
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path("")), {}) == 1);
  const std::string nowhere = folder.path("none/table.csv");
  CHECK_THROWS_WITH(replace_file(nowhere, "new", Durable::kLater),
                    Catch::StartsWith("cannot make " + nowhere + ": "));
}

TEST_CASE("A part of another owner is not taken for one that a kill left behind") {
  const Scratch folder;
  const std::string part = folder.write(".table.csv.part", "of another user");
  std::filesystem::permissions(part, std::filesystem::perms(01644));
  if (::chown(part.c_str(), 12345, static_cast<gid_t>(-1)) != 0)
    return test::leave_out("only root can give a file to another user");
  std::filesystem::permissions(part, std::filesystem::perms(01644));
  replace_file(folder.path("table.csv"), "new", Durable::kLater);
  CHECK(contents(folder.path("table.csv")) == "new");
  CHECK(contents(part) == "of another user");
}

TEST_CASE("A hundred names are tried for a part, and then no part is made") {
  const Scratch folder;
  folder.write(".table.csv.part", "precious");
  for (int number = 1; number < 99; ++number)
    folder.write(".table.csv.part" + std::to_string(number), "precious");
  replace_file(folder.path("table.csv"), "new", Durable::kLater);
  CHECK(files_in(folder) == 100);
  folder.write(".table.csv.part99", "precious");
  CHECK_THROWS_WITH(replace_file(folder.path("table.csv"), "newer", Durable::kLater),
                    Catch::StartsWith("cannot make " + folder.path("table.csv") + ": "));
  CHECK(contents(folder.path("table.csv")) == "new");
}

TEST_CASE("A file that does not fit leaves what was there before") {
  const Scratch folder;
  const std::string path = folder.path("table.csv");
  replace_file(path, "old", Durable::kLater);
  for (const Durable durable : {Durable::kLater, Durable::kNow}) {
    const FullDisk disk(10);
    CHECK_THROWS_WITH(replace_file(path, "eleven byte", durable),
                      "cannot write " + path + ": File too large");
    CHECK(contents(path) == "old");
    CHECK(files_in(folder) == 1);
    replace_file(path, "ten bytes.", durable);
    CHECK(contents(path) == "ten bytes.");
    replace_file(path, "old", durable);
  }
}

TEST_CASE("A budget of the disk gives all that it has, and counts what comes back") {
  DiskBudget budget(10);
  budget.take(10);
  CHECK_THROWS_WITH(budget.take(1), "the recording has reached its limit of 10 bytes");
  CHECK(budget.taken() == 10);
  budget.give_back(4);
  CHECK_THROWS_AS(budget.take(5), BudgetSpent);
  budget.take(4);
  budget.take(0);
  CHECK(budget.taken() == 10);
  CHECK_FALSE(budget.is_given_up());
  const auto given_up = std::make_shared<std::atomic<bool>>(false);
  const DiskBudget other(10, given_up);
  CHECK_FALSE(other.is_given_up());
  *given_up = true;
  CHECK(other.is_given_up());
}

TEST_CASE("A file appears at its commit, with its tail, for everybody to read") {
  const Scratch folder;
  DiskBudget budget(20);
  const mode_t before = ::umask(0077);
  AtomicFile file(folder.path("film.avi"), budget, "tail");
  ::umask(before);
  CHECK(budget.taken() == 4);
  file.write("head");
  file.write(bytes_of("body"));
  file.overwrite(0, bytes_of("HE"));
  CHECK(budget.taken() == 12);
  CHECK_FALSE(std::filesystem::exists(folder.path("film.avi")));
  CHECK(mode_of(file.temporary()) == 0644);
  file.commit();
  CHECK(contents(folder.path("film.avi")) == "HEadbodytail");
  CHECK(mode_of(folder.path("film.avi")) == 0644);
  CHECK(files_in(folder) == 1);
}

TEST_CASE("A file that was not committed leaves nothing, and a file that exists is not replaced") {
  const Scratch folder;
  DiskBudget budget(100);
  AtomicFile(folder.path("film.avi"), budget).write("all");
  CHECK(files_in(folder) == 0);
  AtomicFile late(folder.path("film.avi"), budget);
  folder.write("film.avi", "first");
  CHECK_THROWS_WITH(AtomicFile(folder.path("film.avi"), budget), "film.avi exists; choose another name");
  CHECK_THROWS_WITH(late.commit(), Catch::StartsWith("cannot create film.avi: "));
  CHECK(contents(folder.path("film.avi")) == "first");
  std::filesystem::create_symlink("nothing", folder.path("link.avi"));
  CHECK_THROWS_WITH(AtomicFile(folder.path("link.avi"), budget), "link.avi exists; choose another name");
}

TEST_CASE("What another program has put in the place of a file is not kept as that file") {
  const Scratch folder;
  DiskBudget budget(100);
  const std::string error = "cannot create film.avi: another program has replaced its temporary file";
  for (const bool is_link : {false, true}) {
    AtomicFile file(folder.path("film.avi"), budget);
    file.write("all");
    std::filesystem::remove(file.temporary());
    if (is_link) {
      std::filesystem::create_symlink("nothing", file.temporary());
    } else {
      REQUIRE(::mkfifo(file.temporary().c_str(), 0600) == 0);
    }
    CHECK_THROWS_WITH(file.commit(), error);
    CHECK_FALSE(std::filesystem::exists(std::filesystem::symlink_status(folder.path("film.avi"))));
  }
  CHECK(files_in(folder) == 0);
  AtomicFile file(folder.path("film.avi"), budget);
  std::filesystem::remove(file.temporary());
  CHECK_THROWS_WITH(file.commit(), "cannot create film.avi: No such file or directory");
}

TEST_CASE("A limit of the disk holds to the byte, and a write beyond it writes nothing") {
  const Scratch folder;
  DiskBudget budget(10);
  CHECK_THROWS_AS(AtomicFile(folder.path("film.avi"), budget, "eleven byte"), BudgetSpent);
  CHECK(files_in(folder) == 0);
  CHECK(budget.taken() == 0);
  AtomicFile file(folder.path("film.avi"), budget, "end");
  file.write("1234567");
  CHECK_THROWS_AS(file.write("8"), BudgetSpent);
  CHECK(budget.taken() == 10);
  file.commit();
  CHECK(contents(folder.path("film.avi")) == "1234567end");
}

TEST_CASE("Bytes that the disk did not take are given back, and are not in the file") {
  const Scratch folder;
  DiskBudget budget(100);
  AtomicFile file(folder.path("film.avi"), budget, "end");
  file.write("1234");
  {
    const FullDisk disk(10);
    CHECK_THROWS_WITH(file.write("5678"), "cannot write film.avi: File too large");
    CHECK(budget.taken() == 7);
    file.write("567");  // and the end is at 10
  }
  file.commit();
  CHECK(contents(folder.path("film.avi")) == "1234567end");
}

TEST_CASE("Bytes that another program writes are counted once") {
  const Scratch folder;
  DiskBudget budget(10);
  AtomicFile file(folder.path("film.mp4"), budget);
  file.count_growth();
  CHECK(budget.taken() == 0);
  std::ofstream(file.temporary(), std::ios::binary) << "1234567890";
  file.count_growth();
  file.count_growth();
  CHECK(budget.taken() == 10);
  std::ofstream(file.temporary(), std::ios::binary | std::ios::app) << "1";
  CHECK_THROWS_AS(file.count_growth(), BudgetSpent);
  CHECK(budget.taken() == 10);
}

TEST_CASE("A folder appears at its commit, with whole files") {
  const Scratch folder;
  DiskBudget budget(10);
  const mode_t mask = ::umask(0);
  ::umask(mask);
  {
    AtomicFolder frames(folder.path("frames"), budget);
    frames.add("1.png", bytes_of("12345"));
    CHECK_THROWS_AS(frames.add("2.png", bytes_of("123456")), BudgetSpent);
    CHECK_THROWS_WITH(frames.add("1.png", bytes_of("12345")), "cannot make 1.png: File exists");
    CHECK(budget.taken() == 5);
    {
      const FullDisk disk(4);
      CHECK_THROWS_WITH(frames.add("3.png", bytes_of("12345")), "cannot write 3.png: File too large");
      CHECK(budget.taken() == 5);
    }
    frames.add("4.png", bytes_of("12345"));
    CHECK_FALSE(std::filesystem::exists(folder.path("frames")));
    frames.commit();
  }
  CHECK(contents(folder.path("frames/4.png")) == "12345");
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path("frames")), {}) == 2);
  CHECK(mode_of(folder.path("frames")) == 0755);
  CHECK(mode_of(folder.path("frames/4.png")) == (0644 & ~static_cast<int>(mask)));
  CHECK_THROWS_WITH(AtomicFolder(folder.path("frames"), budget), "frames exists; choose another name");
  { const AtomicFolder folder_of_frames(folder.path("left"), budget); }
  CHECK(files_in(folder) == 1);
}

TEST_CASE("Files are written and removed where the process has no standard input") {
  const Scratch folder;
  DiskBudget budget(100);
  {
    const NoStandardInput closed;
    replace_file(folder.path("table.csv"), "new", Durable::kLater);
    AtomicFolder frames(folder.path("frames"), budget);
    frames.add("1.png", bytes_of("12345"));
    {
      const FullDisk disk(4);
      CHECK_THROWS_WITH(frames.add("2.png", bytes_of("12345")), "cannot write 2.png: File too large");
    }
    frames.add("2.png", bytes_of("12345"));
    frames.commit();
    AtomicFile(folder.path("film.avi"), budget).write("all");
  }
  CHECK(contents(folder.path("frames/2.png")) == "12345");
  CHECK(contents(folder.path("table.csv")) == "new");
  CHECK(files_in(folder) == 2);
}

TEST_CASE("Files leave no descriptor open, committed or not") {
  const Scratch folder;
  DiskBudget budget(1000);
  const std::ptrdiff_t before = open_descriptors();
  for (const bool commits : {false, true}) {
    AtomicFile file(folder.path("film.avi"), budget);
    AtomicFolder frames(folder.path("frames"), budget);
    frames.add("1.png", bytes_of("12345"));
    const FullDisk disk(5);
    CHECK_THROWS(frames.add("2.png", bytes_of("123456")));
    CHECK_THROWS(replace_file(folder.path("table.csv"), "123456", Durable::kLater));
    replace_file(folder.path("table.csv"), "12345", Durable::kNow);
    if (commits) file.commit(), frames.commit();
  }
  CHECK(open_descriptors() == before);
}
