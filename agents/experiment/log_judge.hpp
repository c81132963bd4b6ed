// Plays a log again, and judges whether its row has the result.
#pragma once

#include <string>

#include "agents/experiment/play.hpp"
#include "agents/experiment/results.hpp"
#include "games/images.hpp"

namespace racebeam {

enum class Judgement { kConfirmed, kWrong, kUnchecked };

struct RowVerdict {
  Judgement judgement = Judgement::kWrong;
  std::string reason;       // unless it is confirmed
  std::int64_t frames = 0;  // how many were played
};

// "score is '5'; its log has '4'", for the first column that differs; empty if none does.
std::string first_difference(const ResultRow& row, const ResultRow& truth, const std::string& source);

class LogJudge {
 public:
  // `images` must outlive this. threads: how many call judge() at a time.
  LogJudge(const Images& images, unsigned threads, CpuKind cpu) : images_(images), replayer_(threads, cpu) {}

  // `row` is the log's. Throws InvalidInput for a log that cannot be played.
  RowVerdict judge(const ResultRow& row, const EpisodeLog& log);

 private:
  const Images& images_;
  Replayer replayer_;
};

}  // namespace racebeam
