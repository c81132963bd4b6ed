// Compares the interpreter with the model of reference_cpu.hpp: every opcode from random states, and long
// random programs that use the whole machine.
#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "tests/emulator/bench.hpp"
#include "tests/emulator/reference/reference_machine.hpp"

namespace racebeam::test {
namespace {

using Engine = std::mt19937;

int below(Engine& engine, int limit) { return static_cast<int>(engine() % static_cast<unsigned>(limit)); }
bool percent(Engine& engine, int chance) { return below(engine, 100) < chance; }

Rom random_rom(Engine& engine, bool with_jams) {
  Rom rom(4096);
  do {
    for (std::uint8_t& byte : rom) {
      byte = static_cast<std::uint8_t>(engine());
      if (!with_jams && (byte & 0x1F) == 0x12) byte = 0xEA;
    }
  } while (scheme_name(rom) != "4K");
  return rom;
}

Properties small_window() {
  Properties properties = ntsc();
  properties.ystart = 34;
  properties.height = 16;
  return properties;
}

struct Both {
  explicit Both(const Rom& rom)
      : bench(rom, small_window()), model(rom, {small_window().ystart, small_window().height, true, false}) {
    model.cpu.PC = bench.cpu.PC;
    model.latch = bench.cpu.latch;
  }

  Bench bench;
  ReferenceMachine model;

  void set_registers(int PC, Engine& engine) {
    ReferenceCpu& cpu = model.cpu;
    CpuState& ours = bench.cpu;
    ours.PC = static_cast<std::uint16_t>(cpu.PC = PC);
    ours.A = static_cast<std::uint8_t>(cpu.A = below(engine, 256));
    ours.X = static_cast<std::uint8_t>(cpu.X = below(engine, 256));
    ours.Y = static_cast<std::uint8_t>(cpu.Y = below(engine, 256));
    ours.SP = static_cast<std::uint8_t>(cpu.SP = percent(engine, 30) ? (below(engine, 4) - 2) & 0xFF
                                                                     : below(engine, 256));
    cpu.set_status(below(engine, 256));
    ours.P = static_cast<std::uint8_t>(cpu.status() & 0xCF);
    ours.latch = static_cast<std::uint8_t>(model.latch = below(engine, 256));
    ours.jammed = cpu.jammed = false;
  }

  void set_memory(Engine& engine) {
    for (std::size_t i = 0; i < 128; ++i)
      bench.state.riot.ram[i] = static_cast<std::uint8_t>(model.ram[i] = below(engine, 256));
    const unsigned collisions = engine() & 0xEFFF;  // CXBLPF has no D6
    bench.state.tia.collisions = static_cast<std::uint16_t>(collisions);
    model.tia.meet(collisions);
  }

  void set_time(Engine& engine, int latest) {
    bench.state.cycle = model.cpu.T = below(engine, latest);
    RiotState& riot = bench.state.riot;
    riot.timer = static_cast<std::uint8_t>(model.timer.V = below(engine, 256));
    riot.shift = static_cast<std::uint8_t>(
        model.timer.s = std::vector{0, 3, 6, 10}[static_cast<std::size_t>(below(engine, 4))]);
    riot.timer_set = model.timer.Tset = static_cast<std::uint32_t>(model.cpu.T - below(engine, 300));
    model.timer.late = percent(engine, 20);
    riot.late = model.timer.late;
    riot.late_read = model.timer.R = static_cast<std::uint32_t>(model.cpu.T - below(engine, 100));
  }

  void poke(int address, int value) {
    bench.state.riot.ram[static_cast<std::size_t>(address & 0x7F)] = static_cast<std::uint8_t>(value);
    model.ram[static_cast<std::size_t>(address & 0x7F)] = value;
  }

  void run(int instructions) {
    bench.run_program(instructions);
    model.run(instructions);
    const std::string difference = model.difference(bench.state);
    if (!difference.empty()) FAIL(difference);
    REQUIRE(bench.board.stop == model.stop);
  }

  void close_frame() {
    const auto& theirs = model.tia.buffers()[static_cast<std::size_t>(model.tia.current())];
    const auto [at, expected] = std::mismatch(theirs.begin(), theirs.end(), bench.picture().pixels().begin());
    if (at != theirs.end())
      FAIL("row " << (at - theirs.begin()) / 160 << ", pixel " << (at - theirs.begin()) % 160);
    bench.next_frame(bench.state.cycle);
    model.next_frame();
  }
};

// Addresses at which an opcode can be executed: its places in the image, in any mirror, or RAM.
int place(Both& both, const std::vector<int>& places, int opcode, Engine& engine) {
  if (!places.empty() && percent(engine, 80)) {
    const int offset = places[static_cast<std::size_t>(below(engine, static_cast<int>(places.size())))];
    return offset | 0x1000 | (below(engine, 8) << 13);
  }
  const int address = 0x80 + below(engine, 128);
  both.poke(address, opcode);
  return address | (below(engine, 2) << 8);  // $01xx shows RAM too
}

void check_opcode(Both& both, const Rom& rom, int opcode, int rounds, Engine& engine) {
  std::vector<int> places;
  for (int i = 0; i < 4096; ++i)
    if (rom[static_cast<std::size_t>(i)] == opcode) places.push_back(i);
  for (int round = 0; round < rounds; ++round) {
    both.set_memory(engine);
    both.set_time(engine, 2400);  // before the picture, so that no time is spent on it
    both.set_registers(place(both, places, opcode, engine), engine);
    INFO("round " << round << ", PC " << both.bench.cpu.PC);
    both.run(1);
  }
}

TEST_CASE("Every opcode does what the model does, from random states") {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    Engine engine(seed);
    const Rom rom = random_rom(engine, true);
    Both both(rom);
    for (int opcode = 0; opcode < 256; ++opcode) {
      INFO("seed " << seed << ", opcode " << opcode);
      check_opcode(both, rom, opcode, 60, engine);
    }
  }
}

// Loops that wait for the timer, as games have them, then a write that shows when they ended.
const std::vector<std::vector<std::uint8_t>> kWaits = {
    {0xAD, 0x84, 0x02, 0xD0, 0xFB, 0x85, 0x09},                    // LDA INTIM; BNE; STA COLUBK
    {0xAD, 0x84, 0x02, 0x10, 0xFB, 0x85, 0x09},                    // LDA INTIM; BPL
    {0xAE, 0x84, 0x02, 0xD0, 0xFB, 0x86, 0x09},                    // LDX INTIM; BNE
    {0xAC, 0x84, 0x02, 0x30, 0xFB, 0x84, 0x09},                    // LDY INTIM; BMI
    {0x2C, 0x85, 0x02, 0x10, 0xFB, 0x85, 0x09},                    // BIT INSTAT; BPL
    {0x2C, 0x84, 0x02, 0x10, 0xFB, 0x85, 0x09},                    // BIT INTIM; BPL
    {0xCD, 0x84, 0x02, 0xD0, 0xFB, 0x85, 0x09},                    // CMP INTIM; BNE
    {0xA5, 0x84, 0xD0, 0xFC, 0x85, 0x09},                          // LDA $84; BNE: RAM, never ends
    {0x85, 0x02, 0xCA, 0xD0, 0xFB, 0x85, 0x09},                    // STA WSYNC; DEX; BNE
    {0xA9, 0x02, 0x85, 0x00, 0x85, 0x02, 0xA9, 0x00, 0x85, 0x00},  // a short VSYNC: a frame closes
    {0xA9, 0x20, 0x8D, 0x96, 0x02},                                // TIM64T = $20
    {0xA9, 0x90, 0x8D, 0x95, 0x02},                                // TIM8T = $90
};

void run_random_program(unsigned seed) {
  Engine engine(seed);
  Rom rom = random_rom(engine, percent(engine, 10));
  std::vector<int> entries;
  for (int i = below(engine, 40); i > 0; --i) {
    const auto& wait = kWaits[static_cast<std::size_t>(below(engine, static_cast<int>(kWaits.size())))];
    entries.push_back(below(engine, 4000));
    std::copy(wait.begin(), wait.end(), rom.begin() + entries.back());
  }
  Both both(rom);
  both.set_memory(engine);
  for (int turn = 0; turn < 60; ++turn) {
    INFO("turn " << turn << ", PC " << both.bench.cpu.PC);
    if (percent(engine, 30) || both.bench.cpu.jammed) {
      const int offset =
          entries.empty()
              ? below(engine, 4096)
              : entries[static_cast<std::size_t>(below(engine, static_cast<int>(entries.size())))];
      both.set_registers(0x1000 | offset | (below(engine, 8) << 13), engine);
    }
    both.run(percent(engine, 50) ? 1 + below(engine, 20) : 1 + below(engine, 2000));
    if (both.model.stop || both.model.cpu.T > 40000) both.close_frame();
  }
}

TEST_CASE("Random programs run as on the model, with timer, WSYNC, frames and picture") {
  for (unsigned seed = 1; seed <= 1500; ++seed) {
    INFO("seed " << seed);
    run_random_program(seed);
  }
  // Code in the TIA's own addresses, whose next opcode comes from a collision register.
  for (const unsigned seed : {18060U, 18623U}) {
    INFO("seed " << seed);
    run_random_program(seed);
  }
}

}  // namespace
}  // namespace racebeam::test
