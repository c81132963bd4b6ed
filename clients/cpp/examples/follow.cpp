// Plays Beamfall on eight machines at once: each ship flies to the nearest gap of the beam, and shoots. The
// server's address is in RACEBEAM_ADDRESS.

#include <cmath>
#include <cstdint>
#include <iostream>
#include <racebeam/client.hpp>
#include <vector>

namespace {

using racebeam::client::Bytes;

// Variables of Beamfall in RAM (games/homebrew/README.md).
constexpr int kShipX = 6;
constexpr int kBeam = 15;  // three bytes for each half

constexpr int kMachines = 8, kSteps = 600;
constexpr int kCells = 40;  // of the beam, from left to right
constexpr int kWide = 4;    // cells of a gap that the ship fits into

// Whether a cell of the beam burns. PF0 has four cells, and PF1 has its bits the other way round.
bool burns(const Bytes& ram, int cell) {
  const int half = kBeam + 3 * (cell / 20), place = cell % 20;
  if (place < 4) return (ram[half] >> (4 + place) & 1) != 0;
  if (place < 12) return (ram[half + 1] >> (11 - place) & 1) != 0;
  return (ram[half + 2] >> (place - 12) & 1) != 0;
}

const char* action(const Bytes& ram) {
  const double ship = (ram[kShipX] + 10) / 4.0;
  double nearest = 0;
  int gap = 0;
  for (int cell = 0; cell <= kCells; ++cell) {
    const bool ends = cell == kCells || burns(ram, cell);
    const double distance = cell - gap / 2.0 - ship;
    if (ends && gap >= kWide && (nearest == 0 || std::abs(distance) < std::abs(nearest))) nearest = distance;
    gap = ends ? 0 : gap + 1;
  }
  if (std::abs(nearest) < 0.6) return "FIRE";
  return nearest > 0 ? "RIGHTFIRE" : "LEFTFIRE";
}

}  // namespace

int main() {
  auto game = racebeam::client::connect();
  game.load("beamfall", "seed=1", "frame_skip=4");
  game.observe("reward", "terminated", "truncated", "ram");
  auto reply = game.open(kMachines, "autoreset=same-step");
  std::vector<std::int64_t> scores(kMachines);
  for (int step = 0; step < kSteps; ++step) {
    std::vector<const char*> actions;
    for (const auto& machine : reply) actions.push_back(action(machine.bytes("ram")));
    reply = game.step(actions);
    for (int machine = 0; machine < kMachines; ++machine) scores[machine] += reply[machine].reward();
  }
  std::cout << "scores";
  for (const std::int64_t score : scores) std::cout << ' ' << score;
  std::cout << '\n';
}
