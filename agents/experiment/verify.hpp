// Plays every log of an experiment again, and says whether it gives the row that the results hold.
#pragma once

#include <functional>
#include <string>

#include "agents/experiment/results.hpp"
#include "games/images.hpp"

namespace racebeam {

struct Verdict {
  std::size_t confirmed = 0;  // rows
  std::size_t wrong = 0;      // rows, logs and units that are not as they should be
  std::size_t unchecked =
      0;  // rows whose image or logs are missing, or whose trial diverged or is not finished
  std::int64_t frames = 0;  // that were played
};

// Called with a line for each row that is not confirmed, in the order of the results; then for each row that
// is missing, each unit that is not finished, and each log without a row. Called by one thread at a time.
using FindingCallback = std::function<void(const std::string& line)>;

// The plan of results, which has the images and the version. Throws InvalidInput.
Plan plan_of_results(const ResultsFolder& folder, const Images& images);

// Needs little memory, however many rows there are. Throws InvalidInput if the folder's plan or results.csv
// cannot be read, or its folder of logs is a link.
Verdict verify(const ResultsFolder& folder, const Images& images, unsigned threads, CpuKind cpu,
               const FindingCallback& finding);

}  // namespace racebeam
