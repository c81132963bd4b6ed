#include "system/output_file.hpp"

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <string>
#include <thread>

#include "system/regular_file.hpp"
#include "tests/games/scratch.hpp"
#include "tests/support/skip.hpp"
#include "tests/system/wine.hpp"

using namespace racebeam;

namespace {

constexpr std::size_t kSize = 5000;

std::string text_of(char letter) { return std::string(kSize, letter); }

// What a reader sees who lets others rename the file meanwhile; empty if the file is missing.
std::string seen(const std::string& path) {
  const int file = open_own_file(path);
  if (file < 0) return {};
  std::string text(kSize + 1, '\0');
  text.resize(static_cast<std::size_t>(std::max<std::ptrdiff_t>(read_from(file, text), 0)));
  close_file(file);
  return text;
}

}  // namespace

TEST_CASE("A file that is renamed over another replaces it") {
  const Scratch folder;
  const std::string path = folder.write("file", text_of('a')), next = folder.write("next", text_of('b'));
  REQUIRE(rename_over(next, path));
  CHECK(seen(path) == text_of('b'));
  CHECK_FALSE(std::filesystem::exists(next));
}

TEST_CASE("A reader of a file that is replaced again and again always sees a whole one") {
  const Scratch folder;
  const std::string path = folder.write("file", text_of('a')), next = folder.path("next");
  int replaced = 0;
  std::atomic<bool> ended = false;
  std::thread writer([&] {
    for (char letter = 'b'; letter <= 'z'; ++letter) {
      folder.write("next", text_of(letter));
      replaced += rename_over(next, path) ? 1 : 0;
    }
    ended = true;
  });
  int torn = 0;
  while (!ended) {
    const std::string text = seen(path);
    torn += text.empty() || text != text_of(text.front()) ? 1 : 0;
    std::this_thread::sleep_for(
        std::chrono::milliseconds(1));  // Windows replaces no file that is always open
  }
  writer.join();
  CHECK(torn == 0);
  CHECK(replaced == 25);
  CHECK(seen(path) == text_of('z'));
}

TEST_CASE("A file that is to be new does not replace another") {
  const Scratch folder;
  const std::string path = folder.write("file", text_of('a')), next = folder.write("next", text_of('b'));
  CHECK_FALSE(rename_anew(next, path));
  CHECK(errno == EEXIST);
  CHECK(seen(path) == text_of('a'));
  CHECK(remove_file(path));
  CHECK(rename_anew(next, path));
  CHECK(seen(path) == text_of('b'));
}

TEST_CASE("A file that is made is new, and gets bytes at any place") {
  const Scratch folder;
  const std::string path = folder.path("file");
  const int file = make_file(path);
  REQUIRE(file >= 0);
  CHECK(make_file(path) == -1);
  CHECK(errno == EEXIST);
  CHECK(size_of_file(file) == 0);
  CHECK(write_at(file, 3, "defg"));
  CHECK(write_at(file, 0, "abc"));
  CHECK(size_of_file(file) == 7);
  CHECK(cut_file(file, 5));
  CHECK(sync_file(file));
  close_file(file);
  CHECK(seen(path) == "abcde");
  CHECK(size_of_file(-1) == -1);
  CHECK_FALSE(write_at(-1, 0, "x"));
  CHECK_FALSE(append(-1, "x"));
  CHECK(make_file(folder.path("none/file")) == -1);
}

TEST_CASE("What is appended comes behind all that a file has") {
  const Scratch folder;
  const std::string path = folder.path("file");
  for (const char* const text : {"ab", "cd"}) {
    const int file = open_to_append(path), other = open_to_append(path);
    REQUIRE((file >= 0 && other >= 0));
    CHECK(append(file, text));
    CHECK(append(other, "-"));
    CHECK(append(file, "+"));
    close_file(file);
    close_file(other);
  }
  CHECK(seen(path) == "ab-+cd-+");
}

TEST_CASE("A marked file replaces one that is still marked, and no other") {
  if (test::in_wine()) return test::leave_out("Wine does not keep the attribute that marks a file");
  const Scratch folder;
  const std::string path = folder.path("file");
  const int left_behind = make_marked_file(path);
  REQUIRE(left_behind >= 0);
  CHECK(write_at(left_behind, 0, "old"));
  close_file(left_behind);
  const int file = make_marked_file(path);
  REQUIRE(file >= 0);
  CHECK(size_of_file(file) == 0);
  CHECK(write_at(file, 0, "new"));
  unmark(file);
  close_file(file);
  CHECK(make_marked_file(path) == -1);
  CHECK(errno == EEXIST);
  CHECK(seen(path) == "new");
}

TEST_CASE("The mark of a file changes when another one replaces it") {
  const Scratch folder;
  const std::string path = folder.path("file");
  CHECK(mark_of(path) == FileMark{});
  folder.write("file", "a");
  const FileMark first = mark_of(path);
  CHECK(first.number != 0);
  CHECK(first.is_regular);
  CHECK(mark_of(path) == first);
  REQUIRE(rename_over(folder.write("next", "a"), path));
  CHECK(mark_of(path) != first);
  CHECK_FALSE(mark_of(folder.path("")).is_regular);
}

TEST_CASE("A folder is new when it is made, and empty when it is removed") {
  const Scratch folder;
  const std::string path = folder.path("inner");
  CHECK(make_folder(path));
  CHECK_FALSE(make_folder(path));
  CHECK(errno == EEXIST);
  folder.write("inner/file", "a");
  CHECK_FALSE(remove_folder(path));
  CHECK(remove_file(path + "/file"));
  CHECK_FALSE(remove_file(path + "/file"));
  CHECK(remove_folder(path));
  CHECK_FALSE(std::filesystem::exists(path));
}

TEST_CASE("Temporary files and folders have names of their own") {
  const Scratch folder;
  std::string one = folder.path("a.XXXXXX"), other = one, inner = one;
  const int first = make_temporary_file(one), second = make_temporary_file(other);
  CHECK((first >= 0 && second >= 0 && one != other));
  CHECK(make_temporary_folder(inner));
  CHECK(std::filesystem::is_directory(inner));
  CHECK(sync_disk_of(first));
  CHECK(sync_disk_of(inner));
  CHECK_FALSE(sync_disk_of(folder.path("none")));
  close_file(first);
  close_file(second);
}
