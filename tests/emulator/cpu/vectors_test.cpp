// Runs the published single-instruction vectors on the machine's CPU, wherever the reference equals the chip
// (docs/spec/cpu.md). RACEBEAM_VECTORS names their folder; scripts/check/vectors runs this.
//
// The vectors assume a bus with 64K of plain memory. Here, the board's memory map points at 16K of plain
// memory, for as many addresses as the board decodes. Writes go where the board sends them, and only RAM
// stores them. A vector is left out and counted if it writes elsewhere, or if two of its addresses are the
// same here.
#include <array>
#include <catch2/catch.hpp>
#include <cstdio>
#include <cstdlib>
#include <map>

#include "emulator/base/opcodes.hpp"
#include "tests/emulator/bench.hpp"
#include "tests/emulator/cpu/vectors.hpp"
#include "tests/support/skip.hpp"

namespace racebeam::test {
namespace {

struct VariableNames {
  std::string_view operation, mode;
};

constexpr std::array<VariableNames, 256> kNames = {{
#define OP(code, operation, mode, access, cycles) {#operation, #mode},
#include "emulator/base/opcodes.inc"
#undef OP
}};

constexpr std::uint8_t kDecimal = 0x08, kStored = 0xCF;  // bits of the status

bool is_one_of(std::string_view name, std::initializer_list<std::string_view> list) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

std::uint8_t before_at(const Vector& vector, unsigned address) {
  for (const auto& [at, value] : vector.before.ram)
    if (at == address) return value;
  return 0;
}

// The high byte of the pointer comes from $0100, not $0000 (docs/spec/cpu.md, 4).
bool pointer_wraps(const Vector& vector, std::string_view mode) {
  const unsigned operand = before_at(vector, (vector.before.pc + 1U) & 0xFFFF);
  return (mode == "indirect_y" && operand == 0xFF) ||
         (mode == "indirect_x" && ((operand + vector.before.x) & 0xFF) == 0xFF);
}

// The base of an indexed store, and the address with the index, are in different pages.
bool crosses_page(const Vector& vector, std::string_view mode) {
  const auto at = [&](unsigned address) { return unsigned{before_at(vector, address & 0xFFFF)}; };
  const unsigned operand = at(vector.before.pc + 1U);
  const unsigned low = mode == "indirect_y" ? at(operand) : operand;
  const unsigned index = mode == "absolute_x" ? vector.before.x : vector.before.y;
  return low + index > 0xFF;
}

// Why the reference may differ from the chip, according to the specification; null if they are equal.
const char* difference(const Vector& vector, unsigned opcode) {
  const auto [operation, mode] = kNames[opcode];
  if (operation == "jam") return "jam: the chip stops in its own way (docs/spec/cpu.md, 9)";
  if (is_one_of(operation, {"ane", "lxa"})) return "ane, lxa: depends on the chip (section 6)";
  if (is_one_of(operation, {"sha", "shx", "shy", "shs"}) && crosses_page(vector, mode))
    return "sha, shx, shy, shs across a page: the address is not altered (section 6)";
  if (is_one_of(operation, {"adc", "sbc", "rra", "isb", "arr"}) && (vector.before.p & kDecimal))
    return "decimal mode: N, V, Z and invalid digits (sections 6 and 8)";
  if (pointer_wraps(vector, mode)) return "a pointer at $FF: its high byte comes from $0100 (section 4)";
  return nullptr;
}

// In the packed copy of 2022, undocumented NOPs end before their read: always with an absolute operand, and
// across a page with an indexed one. The chip does read, as the specification says.
bool lacks_its_read(const Vector& vector, unsigned opcode) {
  const auto [operation, mode] = kNames[opcode];
  if (operation != "nop" || !mode.starts_with("absolute")) return false;
  const auto at = [&](unsigned address) { return unsigned{before_at(vector, address & 0xFFFF)}; };
  const unsigned base = at(vector.before.pc + 1U) | at(vector.before.pc + 2U) << 8;
  return vector.cycles.back().address != ((base + (mode == "absolute_x" ? vector.before.x : 0U)) & 0xFFFF);
}

// Cycles that the reference has and the vector has not: lax zp (section 5), and the missing reads.
int extra_cycles(const Vector& vector, unsigned opcode) {
  return (opcode == 0xA7 ? 1 : 0) + (lacks_its_read(vector, opcode) ? 1 : 0);
}

class FlatMachine {
 public:
  FlatMachine() {
    for (std::size_t page = 0; page < pages(); ++page)
      if (!is_ram(static_cast<unsigned>(page * MemoryMap::kPageSize)))
        board().map.page[page] = &memory_[page * MemoryMap::kPageSize];
  }

  // Why the vector cannot be run here; null if it can.
  const char* obstacle(const Vector& vector) const {
    for (const BusAccess& access : vector.cycles)
      if (access.write && !is_ram(access.address)) return "writes outside RAM, which only devices here take";
    std::map<const std::uint8_t*, std::uint16_t> addresses;
    const auto clashes = [&](std::uint16_t address) {
      return addresses.emplace(cell(address), address).first->second != address;
    };
    for (const VectorState* state : {&vector.before, &vector.after})
      for (const auto& [address, value] : state->ram)
        if (clashes(address)) return "two of its addresses are one on this bus";
    return nullptr;
  }

  // The first difference; empty if all is equal.
  std::string run_vector(const Vector& vector, int cycles) {
    put(vector.before);
    racebeam::interpret(board(), 1);
    const CpuState& cpu = bench_.cpu;
    const VectorState& after = vector.after;
    const auto differs = [](const char* what, int here, int there) {
      return std::string(what) + " is " + std::to_string(here) + ", not " + std::to_string(there);
    };
    if (cpu.PC != after.pc) return differs("PC", cpu.PC, after.pc);
    if (cpu.A != after.a) return differs("A", cpu.A, after.a);
    if (cpu.X != after.x) return differs("X", cpu.X, after.x);
    if (cpu.Y != after.y) return differs("Y", cpu.Y, after.y);
    if (cpu.SP != after.s) return differs("SP", cpu.SP, after.s);
    if (cpu.P != (after.p & kStored)) return differs("P", cpu.P, after.p & kStored);
    for (const auto& [address, value] : after.ram)
      if (*cell(address) != value) return differs("a byte of memory", *cell(address), value);
    if (bench_.state.cycle != cycles) return differs("the number of cycles", bench_.state.cycle, cycles);
    return {};
  }

 private:
  static constexpr std::size_t pages() { return std::tuple_size_v<decltype(MemoryMap::page)>; }
  static bool is_ram(unsigned address) { return (address & 0x1280) == 0x0080; }

  Board& board() { return bench_.board; }
  const std::uint8_t* cell(std::uint16_t address) const {
    return bench_.board.map.page_of(address) + address % 64;
  }

  void put(const VectorState& state) {
    for (const auto& [address, value] : state.ram) *const_cast<std::uint8_t*>(cell(address)) = value;
    bench_.state.cpu = CpuState{};
    bench_.cpu.PC = state.pc;
    bench_.cpu.A = state.a;
    bench_.cpu.X = state.x;
    bench_.cpu.Y = state.y;
    bench_.cpu.SP = state.s;
    bench_.cpu.P = state.p & kStored;
    bench_.state.cycle = 0;
    board().code = {};
  }

  Bench bench_;
  std::vector<std::uint8_t> memory_ = std::vector<std::uint8_t>(pages() * MemoryMap::kPageSize);
};

struct Counts {
  long compared = 0;
  std::map<std::string, long> left_out;  // by reason
  long without_read = 0;
  int opcodes = 0;
};

// Returns how many vectors of this opcode were compared.
long compare(FlatMachine& machine, const std::vector<Vector>& vectors, unsigned opcode, Counts& counts) {
  long compared = 0;
  for (const Vector& vector : vectors) {
    const char* reason = difference(vector, opcode);
    if (reason == nullptr) reason = machine.obstacle(vector);
    if (reason != nullptr) {
      ++counts.left_out[reason];
      continue;
    }
    const std::string found =
        machine.run_vector(vector, static_cast<int>(vector.cycles.size()) + extra_cycles(vector, opcode));
    if (!found.empty())
      FAIL_CHECK("vector " << vector.name << " (" << kNames[opcode].operation << "): " << found);
    ++compared;
    if (lacks_its_read(vector, opcode)) ++counts.without_read;
  }
  counts.compared += compared;
  return compared;
}

TEST_CASE("The published vectors of single instructions agree where the reference equals the chip",
          "[vectors]") {
  const char* folder = std::getenv("RACEBEAM_VECTORS");
  if (folder == nullptr || *folder == '\0') {
    test::leave_out(
        "RACEBEAM_VECTORS does not name a folder with the vectors of SingleStepTests, 65x02, "
        "6502/v1");
    return;
  }
  FlatMachine machine;
  Counts counts;
  std::string none_compared;
  for (unsigned opcode = 0; opcode < 256; ++opcode) {
    const auto vectors = read_vectors(folder, opcode);
    if (!vectors) continue;
    ++counts.opcodes;
    if (compare(machine, *vectors, opcode, counts) == 0)
      none_compared.append(" ").append(kNames[opcode].operation).append("/").append(kNames[opcode].mode);
  }
  std::printf("%ld vectors compared, of %d opcodes\n", counts.compared, counts.opcodes);
  std::printf("%8ld of them (undocumented NOPs) lack the read that ends them; one cycle was added\n",
              counts.without_read);
  for (const auto& [reason, count] : counts.left_out)
    std::printf("%8ld left out: %s\n", count, reason.c_str());
  std::printf("opcodes of which none was compared:%s\n",
              none_compared.empty() ? " none" : none_compared.c_str());
  REQUIRE(counts.opcodes > 0);
  CHECK(counts.compared > 0);
}

}  // namespace
}  // namespace racebeam::test
