#include "cli/commands/verify.hpp"

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "agents/experiment/log_judge.hpp"
#include "agents/experiment/rerun.hpp"
#include "agents/experiment/verify.hpp"
#include "agents/experiment/verify_submission.hpp"
#include "cli/arguments/image_options.hpp"
#include "cli/arguments/options.hpp"
#include "environment/settings/play_settings.hpp"
#include "recording/sha256.hpp"
#include "system/input_file.hpp"
#include "system/invalid_input.hpp"
#include "system/printable.hpp"
#include "system/program/signals.hpp"

namespace racebeam {
namespace {

constexpr auto kVerifyFooter =
    R"(Plays the log of each row of RESULTS/results.csv again, and compares the row, its log and what the machine gives.
Each row that is not confirmed gets a line. With --table, also says whether a table or a report was made from
these results: it must contain the SHA-256 of results.csv or of curves.csv. The numbers in a table are not checked,
nor is curves.csv, since episodes of training leave no logs.

RESULTS may be a submission, which has agent.toml and no plan: rows are compared with their logs, and logs with what
the machine gives. That does not prove who chose the actions. RESULTS may be one log, whose name ends with .episode:
what it says of itself is confirmed.

With --rerun N, N units of the plan are played again, training and all. Results are deterministic, so that equal ones
prove that the plan's agent made them. A seed chooses the units, and is printed; --rerun-seed repeats the choice. This
takes as long as `racebeam experiment` took for these units.

Exit status:
  0  all rows are confirmed
  1  rows, logs, tables or units are wrong, missing or too many
  2  nothing is wrong, but some rows could not be checked, such as those of a game without an image,
     or of a unit that is not finished; also a usage error

Examples:
  racebeam verify results --roms ~/atari
  racebeam verify results --roms ~/atari --rerun 3
  racebeam verify results/logs/pong-uct-1/1.episode --roms ~/atari)";

// What the confirmed rows of a submission prove.
constexpr auto kProof =
    "a confirmed row proves that these actions give this score from this start, not who chose the actions";

constexpr auto kRandomSeed = "random";
constexpr std::size_t kMaxTableBytes = std::size_t{1} << 30;

struct VerifyOptions {
  std::string results;
  std::vector<std::string> tables;
  int rerun = 0;  // units
  std::string rerun_seed = kRandomSeed;
  ImageOptions images;
};

// The digests of the tables that others are made from.
struct Digests {
  std::string results, curves;  // curves: empty if the file is missing
};

Digests digests_of(const ResultsFolder& folder) {
  const auto digest = [](const std::string& path) { return sha256_of_file("table", path); };
  return {digest(folder.results()), std::filesystem::exists(folder.curves()) ? digest(folder.curves()) : ""};
}

// Returns whether the file says that it was made from these results.
bool check_table(const std::string& path, const Digests& digests) {
  const std::string text = read_input_file("table", path, kMaxTableBytes);
  const auto has = [&](const std::string& digest) {
    return !digest.empty() && text.find(digest) != std::string::npos;
  };
  const std::string verdict =
      has(digests.results)  ? "says that it was made from these results"
      : has(digests.curves) ? "says that it was made from the curves.csv of these results"
                            : "was not made from these results: it lacks their digest, " + digests.results;
  std::printf("%s %s\n", printable(path).c_str(), verdict.c_str());
  return has(digests.results) || has(digests.curves);
}

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

int status_of(const Verdict& verdict, bool others) {
  if (verdict.wrong > 0 || !others) return 1;
  return verdict.unchecked > 0 ? 2 : 0;
}

bool is_log(const std::string& path) {
  return path.ends_with(".episode") && !std::filesystem::is_directory(path);
}

int verify_log(const VerifyOptions& options) {
  if (!options.tables.empty() || options.rerun > 0)
    throw UsageError(std::string(options.rerun > 0 ? "--rerun" : "--table") +
                     " needs the folder of the results, and this is one log");
  const std::string name = std::filesystem::path(options.results).filename().string();
  const std::string bytes = read_input_file("episode log", options.results, kMaxLogBytes);
  const EpisodeLog log = log_of(name, bytes);
  const Images images = images_of(options.images);
  const auto start = Clock::now();
  const RowVerdict found = LogJudge(images, 1, options.images.cpu).judge(row_of(log, sha256_of(bytes)), log);
  const Verdict verdict{.confirmed = found.judgement == Judgement::kConfirmed,
                        .wrong = found.judgement == Judgement::kWrong,
                        .unchecked = found.judgement == Judgement::kUnchecked};
  std::string line =
      name + " (" + log.game + ", " + log.origin.agent + ", score " + std::to_string(log.end.score) + "): ";
  line += verdict.confirmed ? "confirmed" : verdict.wrong ? "not confirmed: " : "could not be checked: ";
  std::printf("%s; %lld frames in %.1f s\n", printable(line + found.reason).c_str(),
              static_cast<long long>(found.frames), seconds_since(start));
  return status_of(verdict, true);
}

void print_finding(const std::string& line) {
  std::printf("%s\n", printable(line).c_str());
  std::fflush(stdout);
}

std::uint32_t rerun_seed(const VerifyOptions& options) {
  try {
    return parse_seed(options.rerun_seed);
  } catch (const InvalidInput& error) {
    throw UsageError(std::string("--rerun-seed: ") + error.what());
  }
}

// Returns whether all units gave the same.
bool run_again(const VerifyOptions& options, const ResultsFolder& folder, const Images& images) {
  if (options.rerun == 0) return true;
  const Interruption interruption;  // ends after the temporary folder is removed
  RerunSettings settings{.units = options.rerun,
                         .seed = rerun_seed(options),
                         .threads = threads_of(options.images),
                         .cpu = options.images.cpu,
                         .version = RACEBEAM_VERSION};
  settings.check = [&] { interruption.check(); };
  std::printf("units are chosen by --rerun-seed %u\n", settings.seed);
  std::fflush(stdout);
  const RerunVerdict found = rerun(folder, images, settings, print_finding);
  std::printf("%zu units played again: %zu the same, %zu not\n", found.same + found.different, found.same,
              found.different);
  return found.different == 0;
}

void check_folder(const std::string& path) {
  if (!std::filesystem::is_directory(path)) {
    const char* what = std::filesystem::exists(path) ? "this is not a folder" : "no such folder";
    throw InvalidInput("results " + path + ": " + what +
                       "; verify takes a folder, or a log whose name ends with .episode");
  }
  for (const char* name : {"/plan.toml", "/agent.toml"})
    if (std::filesystem::exists(path + name)) return;
  throw InvalidInput("results " + path +
                     ": it has neither plan.toml, as of an experiment, nor agent.toml, as of a submission");
}

int run(const VerifyOptions& options) {
  if (options.rerun == 0 && options.rerun_seed != kRandomSeed) throw UsageError("--rerun-seed needs --rerun");
  if (is_log(options.results)) return verify_log(options);
  check_folder(options.results);
  const ResultsFolder folder(options.results);
  const auto start = Clock::now();
  const Images images = images_of(options.images);
  const bool is_foreign = is_submission(folder);
  const auto check = is_foreign ? verify_submission : verify;
  const Verdict verdict =
      check(folder, images, threads_of(options.images), options.images.cpu, print_finding);
  const double seconds = seconds_since(start);
  bool others = true;
  const Digests digests = digests_of(folder);
  for (const std::string& path : options.tables) others = check_table(path, digests) && others;
  others = run_again(options, folder, images) && others;
  std::printf("%zu rows confirmed, %zu wrong, %zu could not be checked; %lld frames in %.1f s\n",
              verdict.confirmed, verdict.wrong, verdict.unchecked, static_cast<long long>(verdict.frames),
              seconds);
  if (is_foreign) std::printf("%s\n", kProof);
  return status_of(verdict, others);
}

}  // namespace

void add_verify(Subcommand& program) {
  const auto options = std::make_shared<VerifyOptions>();
  Subcommand command = program.add_subcommand(
      "verify", "Play the episodes of an experiment again, and confirm its scores", kVerifyFooter);
  command.option("RESULTS", options->results, "The folder of results or of a submission, or one log")
      .required();
  command.option("--table", options->tables, "A table or report that was made from them; may be repeated")
      .value_name("FILE")
      .one_a_time();
  add_count(command, "--rerun", options->rerun, 0,
            "Run this many units of the plan again, with their agents");
  command.option("--rerun-seed", options->rerun_seed, "What chooses these units: a number, or random")
      .value_name("SEED");
  add_image_options(command, options->images);
  command.exits_with([options] { return run(*options); });
}

}  // namespace racebeam
