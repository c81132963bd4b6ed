#include "system/input_file.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "tests/games/scratch.hpp"

using namespace racebeam;
using Catch::Matchers::Message;

namespace {

#if defined(_WIN32)
constexpr auto kVerbatim = "\\\\?\\";  // before a path that may be long
#else
constexpr auto kVerbatim = "";
#endif

void check_refused(const std::string& path, const std::string& reason) {
  CHECK_THROWS_MATCHES(read_input_file("image", path, 100), InputFileError,
                       Message("image " + path + ": " + reason));
}

}  // namespace

TEST_CASE("a file is read whole, up to the limit") {
  const Scratch folder;
  const std::string path = folder.path("file");
  for (const std::size_t size : {0, 1, 99, 100}) {
    std::ofstream(path, std::ios::binary) << std::string(size, 'x');
    CHECK(read_input_file("image", path, 100) == std::string(size, 'x'));
  }
  std::ofstream(path, std::ios::binary) << std::string(101, 'x');
  check_refused(path, "larger than 100 bytes");
}

TEST_CASE("lines are visited one by one, however long the file is") {
  const Scratch folder;
  const std::string path = folder.path("file");
  const std::string line(1000, 'x');
  {
    std::ofstream file(path, std::ios::binary);
    file << "\n";
    for (int number = 0; number < 1000; ++number) file << line << number << '\n';
    file << "end";
  }
  std::size_t count = 0;
  std::string last;
  each_line("table", path, 1004, [&](std::string_view text, bool ends) {
    if (count > 0 && ends) CHECK(text == line + std::to_string(count - 1));
    CHECK(ends == (count < 1001));
    ++count;
    last = text;
  });
  CHECK(count == 1002);
  CHECK(last == "end");
  CHECK_THROWS_MATCHES(each_line("table", path, 1001, [](std::string_view, bool) {}), InputFileError,
                       Message("table " + path + ": line 12 has more than 1001 bytes"));
}

TEST_CASE("a path may have letters beyond ASCII, and be long") {
  const Scratch scratch;
  const auto folder = std::filesystem::path(kVerbatim + scratch.path("")).make_preferred();
  for (const std::u8string& name : {std::u8string(u8"L\u00F6we \U0001F3AE"), std::u8string(200, u8'x')}) {
    const std::filesystem::path inner = folder / name;
    std::filesystem::create_directory(inner);
    std::ofstream(inner / name, std::ios::binary) << "text";
    const std::string text(name.begin(), name.end());
    CHECK(read_input_file("image", scratch.path(text + "/" + text), 100) == "text");
  }
}

TEST_CASE("anything but a regular file is refused") {
  const Scratch folder;
  check_refused(folder.path("nothing"), "no such file");
  check_refused(folder.path("."), "this is a directory, not a file");
}
