// A folder of results from elsewhere, as `racebeam verify` reads it. The input has three parts, which lines
// "====" divide: agent.toml, or plan.toml after an odd first byte; results.csv; and the contents of the log
// logs/u/1.episode, which the target seals. In the table, the word DIGEST stands for the log's digest.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "agents/experiment/verify_submission.hpp"
#include "fuzz/support/folder.hpp"
#include "fuzz/support/logs.hpp"
#include "fuzz/support/target.hpp"
#include "recording/sha256.hpp"
#include "system/invalid_input.hpp"

namespace racebeam::fuzz {
namespace {

constexpr std::string_view kDivision = "====\n", kDigest = "DIGEST";
constexpr int kMaxRows = 1000;  // of a plan

std::string part_of(std::string_view& text) {
  const std::size_t end = std::min(text.find(kDivision), text.size());
  const std::string part(text.substr(0, end));
  text.remove_prefix(std::min(end + kDivision.size(), text.size()));
  return part;
}

void write(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

std::string with_digest(std::string table, const std::string& digest) {
  for (std::size_t at = 0; (at = table.find(kDigest, at)) != std::string::npos; at += digest.size())
    table.replace(at, kDigest.size(), digest);
  return table;
}

bool is_long_log(std::string_view contents) {
  try {
    return takes_long(log_of("a log", seal(kEpisodeLog, contents)));
  } catch (const InvalidInput&) {
    return false;
  }
}

// A line is said of each row that is missing.
bool is_long_plan(std::string_view text) {
  try {
    const Plan plan = parse_plan(text, "a plan");
    std::int64_t rows = 0;
    for (const Unit& unit : units_of(plan)) rows += unit.agent->length.evaluation_episodes;
    return rows > kMaxRows;
  } catch (const InvalidInput&) {
    return false;
  }
}

// What `racebeam verify` prints of the folder.
std::string verdict_on(const ResultsFolder& folder, CpuKind cpu) {
  std::string text;
  const FindingCallback finding = [&](const std::string& line) { text += line + "\n"; };
  try {
    const bool is_plan = !is_submission(folder);
    const Verdict verdict = is_plan ? verify(folder, own_images(), 1, cpu, finding)
                                    : verify_submission(folder, own_images(), 1, cpu, finding);
    return text + std::to_string(verdict.confirmed) + " " + std::to_string(verdict.wrong) + " " +
           std::to_string(verdict.unchecked);
  } catch (const InvalidInput& refusal) {
    return text + refusal.what();
  }
}

}  // namespace

void run(Bytes input) {
  Reader reader(input);
  const bool is_plan = (reader.byte() & 1) != 0;
  std::string_view rest = text_of(reader.rest());
  const std::string head = part_of(rest), table = part_of(rest);
  if (is_long_log(rest) || (is_plan && is_long_plan(head))) return;
  const ScratchFolder scratch;
  const ResultsFolder folder(scratch.path());
  const std::string log = seal(kEpisodeLog, rest);
  std::filesystem::create_directories(folder.logs("u"));
  write(is_plan ? folder.plan() : folder.root() + "/agent.toml", head);
  write(folder.results(), with_digest(table, sha256_of(log)));
  write(folder.log("u", "1"), log);
  const std::string verdict = verdict_on(folder, CpuKind::kInterpreter);
  require(verdict_on(folder, CpuKind::kAuto) == verdict,
          "results have one verdict, interpreted and translated", verdict);
}

}  // namespace racebeam::fuzz
