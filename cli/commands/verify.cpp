#include "cli/commands/verify.hpp"

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "agents/base/sealed_file.hpp"
#include "agents/experiment/verify.hpp"
#include "cli/arguments/image_options.hpp"
#include "cli/arguments/options.hpp"
#include "system/input_file.hpp"
#include "system/printable.hpp"

namespace racebeam {
namespace {

constexpr auto kVerifyFooter =
    R"(Plays the log of each row of RESULTS/results.csv again, and compares the row, its log and what the machine gives.
Each row that is not confirmed gets a line. With --table, also says whether a table or a report was made from
these results: it must contain the SHA-256 of results.csv or of curves.csv. The numbers in a table are not checked,
nor is curves.csv, since episodes of training leave no logs.

Exit status: 0 all rows are confirmed; 1 rows, logs or tables are wrong, missing or too many; 2 nothing is wrong,
but some rows could not be checked, such as those of a game without an image.

Example:
  racebeam verify results --roms ~/atari)";

constexpr std::size_t kMostTableBytes = std::size_t{1} << 30;

struct VerifyOptions {
  std::string results;
  std::vector<std::string> tables;
  ImageOptions images;
};

// The digests of the tables that others are made from.
struct Digests {
  std::string results, curves;  // curves: empty if there is no such file
};

Digests digests_of(const ResultsFolder& folder) {
  const auto digest = [](const std::string& path) {
    return sha256_of(read_input_file("table", path, kMostTableBytes));
  };
  return {digest(folder.results()), std::filesystem::exists(folder.curves()) ? digest(folder.curves()) : ""};
}

// Returns whether the file says that it was made from these results.
bool check_table(const std::string& path, const Digests& digests) {
  const std::string text = read_input_file("table", path, kMostTableBytes);
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

int run(const VerifyOptions& options) {
  const ResultsFolder folder(options.results);
  const auto start = std::chrono::steady_clock::now();
  const Verdict verdict =
      verify(folder, images_of(options.images), threads_of(options.images), options.images.cpu,
             [](const std::string& line) { std::printf("%s\n", printable(line).c_str()); });
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  bool tables = true;
  const Digests digests = digests_of(folder);
  for (const std::string& path : options.tables) tables = check_table(path, digests) && tables;
  std::printf("%zu rows confirmed, %zu wrong, %zu could not be checked; %lld frames in %.1f s\n",
              verdict.confirmed, verdict.wrong, verdict.unchecked, static_cast<long long>(verdict.frames),
              seconds.count());
  if (verdict.wrong > 0 || !tables) return 1;
  return verdict.unchecked > 0 ? 2 : 0;
}

}  // namespace

void add_verify(Subcommand& program) {
  const auto options = std::make_shared<VerifyOptions>();
  Subcommand command = program.add_subcommand(
      "verify", "Play the episodes of an experiment again, and confirm its scores", kVerifyFooter);
  command.option("RESULTS", options->results, "The folder of the results").required();
  command.option("--table", options->tables, "A table or report that was made from them; may be repeated")
      .one_a_time();
  add_image_options(command, options->images);
  command.exits_with([options] { return run(*options); });
}

}  // namespace racebeam
