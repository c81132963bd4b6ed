#include "cli/commands/experiment.hpp"

#include <csignal>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "agents/experiment/cost.hpp"
#include "agents/experiment/experiment.hpp"
#include "agents/experiment/plan.hpp"
#include "agents/experiment/probe.hpp"
#include "cli/arguments/image_options.hpp"
#include "cli/arguments/options.hpp"
#include "system/invalid_input.hpp"
#include "system/program/signals.hpp"
#include "system/program/standard_streams.hpp"
#include "system/resources.hpp"
#include "system/words.hpp"

namespace racebeam {
namespace {

constexpr auto kExperimentFooter = R"(
The folder of --into gets the plan with every setting written out, results.csv with a row for each evaluation episode,
curves.csv with a row for each training episode, agents.csv, times.csv, and a log of each evaluation episode. A unit is
one trial of one agent in one game. The command can be stopped at any time, and repeated: finished units are not run
again, and unfinished ones continue from their checkpoints. SIGINT, SIGHUP and SIGTERM end it after the current
decisions; a second signal ends it at once.

Examples:
  racebeam experiment smoke --into results
  racebeam experiment hour --roms ~/atari --into results
  racebeam experiment paper --roms ~/atari --into results --shard 3/100
  racebeam verify results)";

std::string footer() {
  std::string text = "PLAN is a TOML file, or the name of a plan that is part of the program:\n";
  for (const ShippedPlan& plan : shipped_plans()) {
    std::string name(plan.name);
    name.resize(12, ' ');
    ((text += "  ") += name).append(plan.summary) += '\n';
  }
  return text + kExperimentFooter;
}

constexpr std::chrono::seconds kMeasurement{8};  // of a dry run
constexpr std::chrono::seconds kReports{1};      // between two changes of the line on a terminal

struct ExperimentOptions {
  std::string plan, into, shard;
  bool dry_run = false, unmeasured = false;
  int checkpoint_seconds = 60;
  ImageOptions images;
};

struct Shard {
  std::size_t number, count;
};

// K/N
std::optional<Shard> shard_of(std::string_view text) {
  const auto count = parse_number<std::size_t>(cut_behind(text, '/'));
  const auto number = parse_number<std::size_t>(text);
  if (!number || !count || *number < 1 || *number > *count) return std::nullopt;
  return Shard{*number, *count};
}

std::string check_shard(const std::string& text) {
  return shard_of(text) ? std::string()
                        : quote(text) + " is not a shard; accepted is K/N, with K from 1 to N";
}

std::string hours(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, seconds < 7200 ? "%.0f min" : "%.1f h",
                seconds < 7200 ? seconds / 60 : seconds / 3600);
  return text;
}

// On a terminal one line that changes, elsewhere a line a unit.
class ProgressLine {
 public:
  ProgressLine() = default;
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ~ProgressLine() { end(); }

  void end() {
    if (is_open_) std::printf("\n");
    is_open_ = false;
    std::fflush(stdout);
  }

  bool changes() const { return terminal_; }
  bool has_reported() const { return has_reported_; }

  void report(const Progress& at) {
    has_reported_ = true;
    std::printf("%s%zu/%zu %s: %d episodes", terminal_ ? "\r\033[K" : "", at.finished, at.all,
                at.unit.c_str(), at.episodes);
    if (at.unit_finished)
      std::printf(", mean score %.1f", at.mean_score);
    else
      std::printf(" and %lld decisions", static_cast<long long>(at.decisions));
    if (terminal_)
      std::printf(", %s left", hours(at.left.count()).c_str());
    else
      std::printf("\n");
    is_open_ = terminal_;
    std::fflush(stdout);
  }

 private:
  const bool terminal_ = is_terminal(kStandardOutput);
  bool is_open_ = false;  // the line has not ended
  bool has_reported_ = false;
};

void print_units(const Plan& plan, const PlayRates& rates, Shard shard) {
  const std::vector<Unit> units = units_of(plan);
  for (std::size_t i = shard.number - 1; i < units.size(); i += shard.count)
    std::printf("unit %s  %.4f core-hours\n", units[i].name.c_str(),
                seconds_of_trial(*units[i].agent, rates.of(plan, *units[i].game, *units[i].agent)) / 3600);
}

// Says where the figures come from.
void print_source(const Plan& plan, const PlayRates& rates) {
  const int longest = plan.play.machine.max_episode_frames;
  if (rates.empty())
    std::printf(
        "core-hours are an estimate: each episode is taken to last %d frames, as long as it may, and speeds "
        "are those of a table\n",
        longest);
  else
    std::printf(
        "core-hours are from a moment of play on this machine, in %zu of %zu games; an episode of a "
        "search is taken to last %d frames, as long as it may\n",
        rates.games(), plan.games.size(), longest);
}

void print_cost(const Plan& plan, const PlayRates& rates, const Images& images) {
  const Cost cost = cost_of(plan, rates);
  for (const AgentCost& agent : cost.agents)
    std::printf("%-12s %6zu units  %14.0f decisions  %12.3f core-hours\n", agent.agent.c_str(), agent.units,
                agent.decisions, agent.core_hours);
  std::printf("%-12s %6zu units  %14.0f decisions  %12.3f core-hours\n", "all", cost.units, cost.decisions,
              cost.core_hours);
  if (cost.discovery_core_hours > 0)
    std::printf("of these, %.3f core-hours are for backgrounds and classes\n", cost.discovery_core_hours);
  print_source(plan, rates);
  std::printf(
      "memory: about %.0f MB, and %.0f MB a thread; disk: about %.0f MB; verification: %.3f core-hours\n",
      kProgramMegabytes, cost.megabytes, cost.disk_megabytes, cost.verification_core_hours);
  for (const std::string& game : games_without_image(plan, images))
    std::printf("missing image: %s\n", game.c_str());
}

void run(const ExperimentOptions& options) {
  const Images images = images_of(options.images);
  Plan plan = load_plan(options.plan, images);
  const Shard shard = shard_of(options.shard).value_or(Shard{1, 1});
  if (options.dry_run) {
    const PlayRates rates = options.unmeasured ? PlayRates() : measure_rates(plan, images, kMeasurement);
    print_units(plan, rates, shard);
    return print_cost(plan, rates, images);
  }
  if (options.into.empty()) throw UsageError("--into is required");
  ExperimentSettings settings;
  settings.threads = threads_of(options.images);
  settings.checkpoints = std::chrono::seconds(options.checkpoint_seconds);
  settings.cpu = options.images.cpu;
  settings.shard = shard.number;
  settings.shards = shard.count;
  bind(plan, images, RACEBEAM_VERSION);
  check_memory(plan, settings.threads, usable_memory());
  const Interruption interruption;  // ends after the tables are put together
  settings.check = [&] { interruption.check(); };
  ProgressLine line;
  if (line.changes()) settings.reports = kReports;
  try {
    run_experiment(plan, images, ResultsFolder(options.into), settings,
                   [&](const Progress& at) { line.report(at); });
  } catch (const Interrupted&) {
    line.end();
    std::fprintf(stderr, "racebeam: a signal ended the experiment; the same command continues it\n");
    throw;
  }
  if (!line.has_reported())
    std::printf("nothing is left to run: other commands have finished these units, or are running them\n");
}

}  // namespace

void add_experiment(Subcommand& program) {
  const auto options = std::make_shared<ExperimentOptions>();
  Subcommand command = program.add_subcommand("experiment", "Run agents on games, as a plan says", footer());
  command.option("PLAN", options->plan, "A plan's name, or a TOML file").required();
  command.option("--into", options->into, "The folder of the results; it may hold a part of them")
      .value_name("DIR");
  command.flag("--dry-run", options->dry_run,
               "Only list the units, their cost, and the images that are missing; measures for some seconds");
  command.flag("--unmeasured", options->unmeasured,
               "With --dry-run: measure nothing, and assume that every episode has the maximum length");
  command
      .option("--shard", options->shard, "Run a part, such as 3/100: each hundredth unit from the third on")
      .value_name("K/N")
      .check({check_shard, ""});
  add_count(command, "--checkpoint-seconds", options->checkpoint_seconds, 0,
            "Least time between two checkpoints of a unit");
  add_image_options(command, options->images);
  command.runs([options] { run(*options); });
}

}  // namespace racebeam
