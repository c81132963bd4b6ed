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
  std::size_t unchecked = 0;  // rows whose image or logs are not here, or whose trial diverged or goes on
  std::int64_t frames = 0;    // that were played
};

// One line for each row that is not confirmed, in the order of the results; then one for each row that is
// missing, unit that goes on, and log that is too many. From one thread at a time.
using Finding = std::function<void(const std::string& line)>;

// The plan of results, which has the images and the version. Throws InvalidInput.
Plan plan_of_results(const ResultsFolder& folder, const Images& images);

// Needs little memory, however many rows there are. Throws InvalidInput if the folder's plan or results.csv
// cannot be read, or its folder of logs is a link.
Verdict verify(const ResultsFolder& folder, const Images& images, unsigned threads, CpuKind cpu,
               const Finding& finding);

}  // namespace racebeam
