// The log of an episode: its contents, which the target seals, or after an odd first byte the whole file.
#include "recording/episode_log.hpp"

#include <string>

#include "agents/experiment/log_judge.hpp"
#include "fuzz/support/logs.hpp"
#include "fuzz/support/target.hpp"
#include "recording/sha256.hpp"
#include "system/invalid_input.hpp"

namespace racebeam::fuzz {
namespace {

// What is said of the log after it was played again.
std::string verdict_on(const EpisodeLog& log, CpuKind cpu) {
  try {
    if (takes_long(log)) return "it takes too long to play";
    const RowVerdict verdict =
        LogJudge(own_images(), 1, cpu).judge(row_of(log, sha256_of(bytes_of(log))), log);
    require((verdict.judgement == Judgement::kConfirmed) == verdict.reason.empty(),
            "each log that is not confirmed gets a reason");
    return verdict.reason;
  } catch (const InvalidInput& refusal) {
    return refusal.what();
  }
}

}  // namespace

void run(Bytes input) {
  Reader reader(input);
  const bool is_file = (reader.byte() & 1) != 0;
  const std::string_view text = text_of(reader.rest());
  EpisodeLog log;
  try {
    log = log_of("fuzzed.episode", is_file ? std::string(text) : seal(kEpisodeLog, text));
  } catch (const InvalidInput& refusal) {
    require(std::string_view(refusal.what()).starts_with("episode log fuzzed.episode: "),
            "an error names the file", refusal.what());
    return;
  }
  const std::string written = bytes_of(log);
  require(bytes_of(log_of("written.episode", written)) == written, "a log is written as it was read");
  const std::string verdict = verdict_on(log, CpuKind::kInterpreter);
  require(verdict_on(log, CpuKind::kAuto) == verdict, "a log has one verdict, interpreted and translated",
          verdict);
}

}  // namespace racebeam::fuzz
