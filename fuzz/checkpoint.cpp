// The checkpoint of a trial. The first byte selects the agent, and whether the rest is the checkpoint's
// contents, or alters those that the agent wrote, five bytes at a time: place (three bytes, low byte first),
// operation, value.
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "agents/experiment/trial.hpp"
#include "agents/features/game_facts.hpp"
#include "fuzz/support/folder.hpp"
#include "fuzz/support/keep_code.hpp"
#include "fuzz/support/target.hpp"
#include "system/invalid_input.hpp"

namespace racebeam::fuzz {
namespace {

constexpr std::uint8_t kWhole = 0x80;
constexpr std::chrono::hours kNever{1};

// An agent of each class that carries something from one episode to the next.
constexpr std::string_view kPlan = R"(games = ["beamfall"]
agents = ["random", "basic", "blob_prost", "uct", "full_tree", "rollout_iw1"]
trials = 1
training_episodes = 2
evaluation_episodes = 2
background_screens = 10
environment = "max_episode_frames=30 sticky=0.25"
[agent.basic]
grid_width = 2
grid_height = 2
[agent.blob_prost]
most_features = 2000
[agent.uct]
evaluation_episodes = 2
simulations = 2
depth_frames = 20
[agent.full_tree]
evaluation_episodes = 2
frames = 20
[agent.rollout_iw1]
evaluation_episodes = 2
frames = 20
)";

struct Experiment {
  Experiment() : plan(parse_plan(kPlan, "fuzzed.toml")), cartridge(*images.find("beamfall")) {
    keep_code(cartridge);
    bind(plan, images, "0.1.0");
    units = units_of(plan);
    facts = std::make_unique<GameFacts>(cartridge, sample_settings(plan, plan.games[0]), "");
    for (const Unit& unit : units) checkpoints.push_back(contents_after_an_episode(unit));
  }

  Trial trial(const Unit& unit, const ResultsFolder& folder) const {
    return {plan, unit, folder, cartridge, facts.get(), CpuKind::kAuto};
  }

  std::string contents_after_an_episode(const Unit& unit) const {
    const ScratchFolder scratch;
    const ResultsFolder folder(scratch.path());
    std::filesystem::create_directories(folder.work());
    int episodes = 0;
    trial(unit, folder).run(std::chrono::milliseconds(0), [&] { return episodes++ == 1; });
    return read_sealed(kCheckpoint, folder.checkpoint(unit.name));
  }

  Images images;
  Plan plan;
  Cartridge cartridge;
  std::vector<Unit> units;
  std::unique_ptr<GameFacts> facts;
  std::vector<std::string> checkpoints;  // contents, one for each unit
};

std::string altered(std::string contents, Reader& changes) {
  while (!changes.empty() && !contents.empty()) {
    const std::size_t place = (changes.word() | std::size_t{changes.byte()} << 16) % contents.size();
    const std::uint8_t operation = changes.byte();
    const auto value = static_cast<char>(changes.byte());
    switch (operation % 4) {
      case 0: contents[place] = value; break;
      case 1: contents[place] = static_cast<char>(contents[place] ^ value); break;
      case 2: contents[place] = static_cast<char>(contents[place] + value); break;
      default: contents.resize(contents.size() - static_cast<std::uint8_t>(value) % contents.size());
    }
  }
  return contents;
}

}  // namespace

void run(Bytes input) {
  static const Experiment experiment;
  Reader reader(input);
  const std::uint8_t first = reader.byte();
  const std::size_t number = (first & ~kWhole) % experiment.units.size();
  const Unit& unit = experiment.units[number];
  const std::string contents = (first & kWhole) != 0 ? std::string(text_of(reader.rest()))
                                                     : altered(experiment.checkpoints[number], reader);
  const ScratchFolder scratch;
  const ResultsFolder folder(scratch.path());
  std::filesystem::create_directories(folder.work());
  std::filesystem::create_directories(folder.units());
  std::ofstream(folder.checkpoint(unit.name), std::ios::binary) << seal(kCheckpoint, contents);
  try {
    require(experiment.trial(unit, folder).run(kNever, [] { return false; }),
            "a trial goes on from a checkpoint that was accepted, and ends");
  } catch (const InvalidInput& refusal) {
    require(std::string_view(refusal.what()).starts_with("checkpoint " + folder.checkpoint(unit.name)),
            "an error names the file", refusal.what());
  }
}

}  // namespace racebeam::fuzz
