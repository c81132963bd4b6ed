// The feature set that HACKING.md shows.
#include <catch2/catch.hpp>

#include "agents/experiment/play.hpp"
#include "agents/kinds/learner.hpp"
#include "tests/agents/experiment/samples.hpp"

using namespace racebeam;
using namespace racebeam::test;

namespace {

#include "ram_bytes.inc"

}  // namespace

TEST_CASE("HACKING.md's feature set has a feature for each byte of RAM, and learns") {
  Environment machine(beamfall().image, beamfall().game, short_episodes().machine);
  for (int i = 0; i < kRamSize; ++i) machine.set_ram(i, static_cast<std::uint8_t>(255 - i));
  RamBytes features;
  ActiveFeatures active;
  for (int again = 0; again < 2; ++again) {
    features.extract(machine, active);
    REQUIRE(active.indices.size() == kRamSize);
    for (std::uint32_t i = 0; i < kRamSize; ++i) CHECK(active.indices[i] == 256 * i + 255 - i);
  }
  CHECK(features.size() == 32768);

  Learner learner(std::make_unique<RamBytes>(), SarsaSettings{}, 1);
  Stage stage(beamfall(), short_episodes(), learner.drawing());
  stage.begin(1);
  CHECK(play(learner, stage).actions.size() > 100);
  CHECK(!learner.diverged());
}
