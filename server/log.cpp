#include "server/log.hpp"

#include <unistd.h>

namespace racebeam {

void log(const std::string& sentence) {
  const std::string line = "racebeam: " + sentence + "\n";
  // When this fails there is nobody left to complain to.
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, line.data(), line.size());
}

}  // namespace racebeam
