// Plays every log of a submission again: results of anybody's agent, without a plan (docs/evaluation.md).
#pragma once

#include "agents/experiment/verify.hpp"

namespace racebeam {

// Whether the folder has an agent.toml, and no plan.
bool is_submission(const ResultsFolder& folder);

// Compares each row with its log, and its log with what the machine gives, as verify() does. All logs must
// have the same settings, but for the seed. Throws InvalidInput if results.csv cannot be read, or the folder
// of logs is a link.
Verdict verify_submission(const ResultsFolder& folder, const Images& images, unsigned threads, CpuKind cpu,
                          const FindingCallback& finding);

}  // namespace racebeam
