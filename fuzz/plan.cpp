// The plan of an experiment. If it is accepted, the plan that is written with every default must be the same.
#include "agents/experiment/plan.hpp"

#include "fuzz/support/target.hpp"
#include "system/invalid_input.hpp"
#include "system/printable.hpp"

namespace racebeam::fuzz {

void run(Bytes input) {
  std::string written;
  try {
    written = text_of(parse_plan(text_of(input), "fuzzed.toml"));
  } catch (const InvalidInput& refusal) {
    require(std::string_view(refusal.what()).starts_with("fuzzed.toml"), "an error names the file",
            refusal.what());
    require(printable(refusal.what()) == refusal.what(), "an error is printable", refusal.what());
    return;
  }
  require(text_of(parse_plan(written, "written.toml")) == written, "a plan is written as it was read",
          written);
}

}  // namespace racebeam::fuzz
