#include "cli/bench/bench.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <span>

#include "cli/arguments/actions.hpp"
#include "cli/arguments/options.hpp"
#include "cli/bench/batch_bench.hpp"
#include "cli/bench/bench_session.hpp"
#include "cli/bench/cpu_clock.hpp"
#include "cli/bench/reset_bench.hpp"
#include "cli/bench/search_bench.hpp"
#include "cli/bench/snapshot_bench.hpp"

namespace racebeam {
namespace {

constexpr auto kBenchFooter =
    R"(Measures the processor time of acts; that of resets is apart. Without --actions, the game's legal actions
are drawn at random from a fixed seed, so that two runs do the same.

  --screen every   every frame's screen is produced, also those in the middle of a frame skip
  --screen last    the screen after each act
  --screen none    rewards and RAM only

The checksums of the last screen and of RAM show that different settings did the same work. Compare
ratios measured in one run (scripts/bench), not times from different days.

--save-restore prints these times, in nanoseconds:
  the machine's state, copied out and back
  its hash, and its comparison with another, as planners need them
  a client's snapshot, which has the pictures, too
  a save, a frame and a restore, beside a frame: the frame must not draw on the saved picture

--commands reads requests from standard input, one a line, and answers each with a line of JSON. Another program
can thus let two machines play the same acts in turns:
  play A A ...    plays these actions, one act each, timed; a game that is over is reset
  check A A ...   the same, not timed, with a checksum of what each act led to
  reset N         times N resets
  save N          times N snapshots, each taken and restored at once

--batch N steps N machines together. Their observations are stacks of four grey screens of 84 x 84, each the
brighter of the last two frames. --actions are then indices into the minimal actions, one for each machine and
step. Frames a second are then measured in wall time.

Examples:
  racebeam bench --rom pong.bin --batch 64 --threads 2 --frame-skip 4 --frames 500000
  racebeam bench --rom pong.bin --search --frame-skip 5
  racebeam bench --rom pong.bin --frames 20000 --frame-skip 4 --screen last)";

enum class Screens { kEvery, kLast, kNone };

struct BenchOptions {
  MachineOptions machine;
  std::string actions;
  int frames = 20000;
  std::string screen = "every";
  bool json = false;
  bool save_restore = false;
  bool commands = false;
  BatchBenchOptions batch;
  bool search = false;
  int resets = 0;  // 0: resets are not measured on their own
};

struct Totals {
  int frames = 0, acts = 0, resets = 0, screens = 0, reward = 0;
  double play_seconds = 0, reset_seconds = 0;
};

// Like those of a player: each action is held for some frames, four on average.
std::vector<int> random_actions(const std::vector<int>& legal, int count) {
  std::mt19937 generator{1};
  std::vector<int> actions;
  for (int i = 0; i < count; ++i) {
    const bool hold = i > 0 && generator() % 4 != 0;
    actions.push_back(hold ? actions.back() : legal[generator() % legal.size()]);
  }
  return actions;
}

std::vector<int> choose_actions(const BenchOptions& options, const Game& game) {
  if (options.actions.empty()) return random_actions(game.legal_actions, options.frames);
  const auto actions = read_actions(options.actions);
  if (actions.empty()) throw std::invalid_argument("'" + options.actions + "' has no actions");
  return actions;
}

class Bench {
 public:
  Bench(const BenchOptions& options, const Cartridge& cartridge)
      : screen_(options.screen == "every"  ? Screens::kEvery
                : options.screen == "last" ? Screens::kLast
                                           : Screens::kNone),
        repeat_(screen_ == Screens::kEvery ? options.machine.settings.frame_skip : 1),
        limit_(options.frames),
        actions_(choose_actions(options, *cartridge.game)),
        environment_(power_on(cartridge, frame_by_frame(options.machine, screen_))) {
    if (screen_ == Screens::kNone) environment_.set_drawing(Drawing::kNone);
  }

  Totals run() {
    while (totals_.frames < limit_) {
      play();
      if (environment_.game_over()) reset();
    }
    return totals_;
  }

  const Environment& environment() const { return environment_; }

 private:
  // To observe every frame of a skip, the machine acts once a frame.
  static MachineOptions frame_by_frame(MachineOptions machine, Screens screen) {
    if (screen == Screens::kEvery) machine.settings.frame_skip = 1;
    return machine;
  }

  void play() {
    const int frames_before = totals_.frames;
    const int first = environment_.frame_number();
    const double start = cpu_seconds();
    while (totals_.frames < limit_ && !environment_.game_over()) {
      const int action = actions_[static_cast<std::size_t>(totals_.acts++) % actions_.size()];
      for (int i = 0; i < repeat_ && !environment_.game_over(); ++i) act(action);
      totals_.frames = frames_before + environment_.frame_number() - first;
    }
    totals_.play_seconds += cpu_seconds() - start;
  }

  void act(int action) {
    totals_.reward += environment_.act(action);
    if (screen_ != Screens::kNone) totals_.screens += !environment_.screen().empty();
  }

  void reset() {
    const double start = cpu_seconds();
    environment_.reset_game();
    if (environment_.game_over())
      throw std::runtime_error("the game is over right after its reset: nothing can be measured");
    totals_.reset_seconds += cpu_seconds() - start;
    ++totals_.resets;
  }

  Screens screen_;
  int repeat_;
  int limit_;
  std::vector<int> actions_;
  Environment environment_;
  Totals totals_;
};

std::string crc(std::span<const std::uint8_t> bytes) {
  char text[9];
  std::snprintf(text, sizeof text, "%08lx", crc32(0, bytes.data(), static_cast<uInt>(bytes.size())));
  return text;
}

nlohmann::ordered_json report(const BenchOptions& options, const Totals& totals,
                              const Environment& environment) {
  return {
      {"game", environment.game().name},
      {"md5", environment.image().md5},
      {"frames", totals.frames},
      {"acts", totals.acts},
      {"frame_skip", options.machine.settings.frame_skip},
      {"cpu_seconds", totals.play_seconds},
      {"frames_per_second", totals.frames / totals.play_seconds},
      {"resets", totals.resets},
      {"reset_cpu_seconds", totals.reset_seconds},
      {"screen", options.screen},
      {"screens", totals.screens},
      {"audio", environment.settings().sound},
      {"reward", totals.reward},
      {"last_screen_crc", crc(environment.screen())},
      {"last_ram_crc", crc(environment.ram())},
  };
}

void add_snapshots(nlohmann::ordered_json& figures, const SnapshotTimes& times) {
  figures["machine_state_bytes"] = times.machine_bytes;
  figures["machine_save_restore_ns"] = times.machine_ns;
  figures["state_hash_ns"] = times.hash_ns;
  figures["state_compare_ns"] = times.compare_ns;
  figures["client_save_restore_ns"] = times.client_ns;
  figures["client_save_frame_restore_ns"] = times.round_ns;
  figures["client_frame_ns"] = times.frame_ns;
}

std::string in_words(const nlohmann::ordered_json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  char text[32];
  std::snprintf(text, sizeof text, value.is_number_float() ? "%.6g" : "%.0f", value.get<double>());
  return text;
}

void print(const nlohmann::ordered_json& figures) {
  for (const auto& [key, value] : figures.items()) {
    std::string name = key;
    std::replace(name.begin(), name.end(), '_', ' ');
    std::printf("%-30s%s\n", name.c_str(), in_words(value).c_str());
  }
}

void run_commands(const BenchOptions& options, const Cartridge& cartridge) {
  if (options.screen == "every" && options.machine.settings.frame_skip > 1)
    throw std::invalid_argument(
        "--commands observes one screen a frame skip: give --screen last or none with --frame-skip " +
        std::to_string(options.machine.settings.frame_skip));
  run_bench_session(cartridge, options.machine, options.screen != "none", std::cin, std::cout);
}

void show(const nlohmann::ordered_json& figures, bool json) {
  json ? void(std::cout << figures.dump() << '\n') : print(figures);
}

void run_batch(const BenchOptions& options) {
  const auto actions = options.actions.empty() ? std::vector<int>{} : read_actions(options.actions);
  show(time_batch(open_cartridge(options.machine), options.machine, options.batch, options.frames, actions),
       options.json);
}

void run(const BenchOptions& options) {
  if (options.batch.machines > 0) return run_batch(options);
  const Cartridge cartridge = open_cartridge(options.machine);
  if (options.commands) return run_commands(options, cartridge);
  if (options.resets > 0) return show(time_resets(cartridge, options.machine, options.resets), options.json);
  if (options.search) return show(time_search(cartridge, options.machine), options.json);
  Bench bench{options, cartridge};
  const Totals totals = bench.run();
  auto figures = report(options, totals, bench.environment());
  if (options.save_restore) add_snapshots(figures, time_snapshots(cartridge, options.machine));
  show(figures, options.json);
}

}  // namespace

void add_bench(Subcommand& program) {
  const auto options = std::make_shared<BenchOptions>();
  Settings& settings = options->machine.settings;
  settings.random_seed = 123;
  settings.sticky = 0;

  Subcommand command = program.add_subcommand("bench", "Measure how fast a game runs", kBenchFooter);
  add_machine_options(command, options->machine);
  command.find("--seed").help("Seed of the actions and of the sticky actions");
  command
      .option("--actions", options->actions,
              "Repeat the actions of this file (in the format of racebeam trace)")
      .value_name("FILE");
  add_count(command, "--frames", options->frames, 1, "Frames to play");
  command.option("--screen", options->screen, "Which screens to produce: every, last or none")
      .check(one_of({"every", "last", "none"}))
      .value_name("NAME")
      .shows_default();
  command.flag("--audio", settings.sound, "Also produce sound");
  command.flag("--save-restore", options->save_restore, "Also measure saving and restoring");
  command.flag("--commands", options->commands, "Execute the commands on standard input, line by line");
  add_count(command, "--batch", options->batch.machines, 1, "Measure a batch of this many machines instead");
  add_count(command, "--threads", options->batch.threads, 1,
            "Threads of the batch (default: one for each processor)");
  command.flag("--same-step", options->batch.same_step,
               "Machines of the batch reset in the step that ends an episode");
  command.flag("--search", options->search,
               "Measure a planner's work instead: 500 random branches of 300 frames from one state");
  add_count(command, "--resets", options->resets, 1, "Measure this many resets instead, in milliseconds");
  command.flag("--json", options->json, "Print the figures as one JSON object");
  command.runs([options] { run(*options); });
}

}  // namespace racebeam
