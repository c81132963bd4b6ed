// Tests saved states of all games: see check.hpp. scripts/check/snapshots runs this.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <mutex>
#include <thread>

#include "games/catalogue.hpp"
#include "tests/snapshots/check.hpp"
#include "tests/snapshots/run.hpp"
#include "tests/support/roms.hpp"

namespace racebeam::test {
namespace {

constexpr int kOwnGamesFactor = 8;  // our own images are always there, and get more frames

struct Options {
  Plan plan;
  std::vector<std::string> games;  // empty: all
  unsigned threads = std::max(1U, std::thread::hardware_concurrency());
  bool verbose = false;
};

std::shared_ptr<const Image> image_of(const CatalogueEntry& entry, const Game& game) {
  return entry.built_in ? load_image("builtin:" + std::string(entry.name)) : find_rom_of(game);
}

// Why no machine can run the game; empty if one can.
std::string obstacle(const std::shared_ptr<const Image>& image, const std::shared_ptr<const Game>& game) {
  try {
    const Environment environment(image, game, Settings{});
    return {};
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

struct Collection {
  std::vector<Cartridge> cartridges;
  std::vector<std::string> missing;  // games, and why they can't be run
};

Collection collect(const std::vector<std::string>& names) {
  Collection all;
  for (const CatalogueEntry& entry : catalogue()) {
    if (!names.empty() && std::ranges::find(names, entry.name) == names.end()) continue;
    const auto game = find_game(entry.name);
    const auto image = image_of(entry, *game);
    const std::string why = image ? obstacle(image, game) : "no image in RACEBEAM_ROMS or .venv";
    if (why.empty()) {
      all.cartridges.push_back({image, game, entry.built_in});
    } else {
      all.missing.push_back(game->name + ": " + why);
    }
  }
  return all;
}

std::string check_game(const Cartridge& cartridge, const Cartridge& other, Plan plan) {
  if (cartridge.own) plan.frames *= kOwnGamesFactor;
  try {
    for (int number = 0; number < kManners; ++number)
      if (std::string fault = check_run(cartridge, other, number, plan); !fault.empty()) return fault;
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

// Distributes the games over threads. Returns how many had a fault.
int check_games(const std::vector<Cartridge>& cartridges, const Options& options) {
  std::atomic<std::size_t> next = 0;
  std::atomic<int> faults = 0;
  std::mutex printing;
  const auto work = [&] {
    for (std::size_t i = next++; i < cartridges.size(); i = next++) {
      const Cartridge& other = cartridges[(i + 1) % cartridges.size()];
      const std::string fault = check_game(cartridges[i], other, options.plan);
      const std::lock_guard lock(printing);
      if (!fault.empty()) ++faults;
      if (!fault.empty() || options.verbose)
        std::printf("%-20s %s\n", cartridges[i].game->name.c_str(), fault.empty() ? "same" : fault.c_str());
      std::fflush(stdout);
    }
  };
  std::vector<std::jthread> threads;
  for (unsigned i = 0; i < options.threads; ++i) threads.emplace_back(work);
  threads.clear();
  return faults;
}

int run_checks(const Options& options) {
  const Collection all = collect(options.games);
  for (const std::string& one : all.missing) std::printf("SKIPPED: %s\n", one.c_str());
  if (all.cartridges.empty()) throw std::runtime_error("unknown game, or no image of it was found");
  const int faults = check_games(all.cartridges, options);
  std::printf(
      "%zu games, the state at each of %d frames (%d in our own), %d acts after each, in %d manners: %d "
      "differ\n",
      all.cartridges.size(), options.plan.frames, options.plan.frames * kOwnGamesFactor, options.plan.ahead,
      kManners, faults);
  return faults == 0 ? 0 : 1;
}

int run(int argc, char** argv) {
  CLI::App app("Checks, for every game, that the state at each frame of a random run can be restored");
  Options options;
  Resumption resumption;
  options.plan.frames = 6;
  app.add_option("--frames", options.plan.frames, "Consecutive frames of each game whose state is restored")
      ->envname("RACEBEAM_SNAPSHOT_FRAMES")
      ->check(CLI::PositiveNumber);
  app.add_option("--ahead", options.plan.ahead, "Acts after each restored state that are compared")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--seed", options.plan.seed, "Seed of the runs");
  app.add_option("--games", options.games, "Names of games (default: all)")->delimiter(',');
  app.add_option("--threads", options.threads, "Games that run in parallel")->check(CLI::PositiveNumber);
  app.add_flag("--verbose", options.verbose, "Print a line for each game");
  app.add_option("--resume", resumption.folder)->group("");  // for the other processes
  app.add_option("--manner", resumption.manner)->group("");
  app.add_option("--first", resumption.first)->group("");
  CLI11_PARSE(app, argc, argv);
  if (resumption.folder.empty()) {
    options.plan.executable = std::filesystem::read_symlink("/proc/self/exe").string();
    return run_checks(options);
  }
  resumption.game = options.games.at(0);
  resumption.acts = options.plan.ahead;
  resumption.seed = options.plan.seed;
  resume(resumption);
  return 0;
}

}  // namespace
}  // namespace racebeam::test

int main(int argc, char** argv) {
  try {
    return racebeam::test::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "snapshots: %s\n", error.what());
    return 1;
  }
}
