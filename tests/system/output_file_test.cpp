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
