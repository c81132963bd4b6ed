// Single-instruction vectors in the format of SingleStepTests (65x02, folder 6502/v1): a state, an
// instruction, the state after it, and every bus access. The tree contains none.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace racebeam::test {

struct VectorState {
  std::uint16_t pc = 0;
  std::uint8_t s = 0, a = 0, x = 0, y = 0, p = 0;
  std::vector<std::pair<std::uint16_t, std::uint8_t>> ram;
};

struct BusAccess {
  std::uint16_t address = 0;
  std::uint8_t value = 0;
  bool write = false;
};

struct Vector {
  std::string name;
  VectorState before, after;
  std::vector<BusAccess> cycles;
};

// Reads the vectors of one opcode from the file XX.json in `folder`, or from XX.bin (the same data, packed,
// as in the repository jepebe/ProcessorTestsBinaries). Returns nothing if neither exists. Throws
// std::runtime_error for an invalid file.
std::optional<std::vector<Vector>> read_vectors(const std::string& folder, unsigned opcode);

}  // namespace racebeam::test
