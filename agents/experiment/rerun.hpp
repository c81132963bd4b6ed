// Runs units of an experiment again, with their agents. Results are deterministic, so that equal results
// prove that the agent of the plan made them.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "agents/experiment/verify.hpp"

namespace racebeam {

struct RerunSettings {
  int units = 1;           // how many; all, if the plan has fewer
  std::uint32_t seed = 1;  // chooses them
  unsigned threads = 1;
  CpuKind cpu = CpuKind::kAuto;
  std::string version;  // of this program; the plan must have it, too
  // Called after each decision, by all threads. An exception that it throws ends the run.
  std::function<void()> check = {};
};

struct RerunVerdict {
  std::size_t same = 0, different = 0;  // units
};

// Runs the chosen units, and compares their rows of results.csv and curves.csv. Backgrounds and classes are
// discovered anew, except for those that the plan has from a CSV file. Calls finding() with a line for each
// unit, from one thread at a time. Throws InvalidInput for a folder without a plan, a plan of another
// version, and games without an image.
RerunVerdict rerun(const ResultsFolder& folder, const Images& images, const RerunSettings& settings,
                   const FindingCallback& finding);

}  // namespace racebeam
