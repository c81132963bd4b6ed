// Runs a target without libFuzzer, with the named files and those in named folders.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <vector>

#include "fuzz/support/target.hpp"

namespace fs = std::filesystem;

namespace {

std::set<fs::path> files_of(std::span<char*> arguments) {
  std::set<fs::path> files;
  for (const fs::path argument : arguments) {
    if (!fs::is_directory(argument)) {
      files.insert(argument);
    } else {
      for (const auto& entry : fs::directory_iterator(argument)) files.insert(entry.path());
    }
  }
  return files;
}

bool run_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    std::fprintf(stderr, "replay: cannot read '%s'\n", path.c_str());
    return false;
  }
  const std::vector<char> input{std::istreambuf_iterator<char>(file), {}};
  std::printf("%s\n", path.c_str());  // the last name printed is that of the input that failed
  std::fflush(stdout);
  racebeam::fuzz::run({reinterpret_cast<const std::uint8_t*>(input.data()), input.size()});
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  const auto files = files_of({argv + 1, argv + argc});
  if (files.empty()) {
    std::fprintf(stderr, "usage: %s FILE|FOLDER...    runs these inputs; one that fails aborts\n", argv[0]);
    return 2;
  }
  for (const fs::path& file : files) {
    if (!run_file(file)) return 1;
  }
  std::printf("%zu inputs\n", files.size());
}
