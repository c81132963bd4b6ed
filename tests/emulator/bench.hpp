// A machine on the bench: a board whose registers are reached by hand at chosen cycles, or whose processor
// runs a few instructions at a time. Frames open and close as in Console::step().
#pragma once

#include <array>
#include <memory>
#include <span>
#include <utility>

#include "emulator/board.hpp"
#include "emulator/cpu.hpp"
#include "emulator/registers.hpp"

namespace racebeam::test {

constexpr int kLineCycles = 76;

// The window of the examples in the specification.
inline Properties ntsc() {
  Properties properties;
  properties.format = Format::kNtsc;
  return properties;
}

struct Bench {
  explicit Bench(Rom rom = Rom(4096, 0xEA), const Properties& properties = ntsc())
      : whole_(std::make_unique<Whole>(std::make_shared<const Rom>(std::move(rom)), properties)) {
    board.slot.scheme.reset(board.slot);
    board.map_memory();
    reset_cpu(board);
    state.frame.open = 1;
    board.open_frame();
    board.begin_step(picture());
  }

 private:
  void run_at(int cycle, unsigned opcode, unsigned operand) {
    state.riot.ram[0] = static_cast<std::uint8_t>(opcode);
    state.riot.ram[1] = static_cast<std::uint8_t>(operand);
    cpu.PC = 0x80;
    state.cycle = cycle - 3;
    run(board, 1);
  }

  struct Whole {
    Whole(std::shared_ptr<const Rom> rom, const Properties& properties) : board(std::move(rom), properties) {}
    Board board;
    std::array<Picture, 2> pictures;
  };
  std::unique_ptr<Whole> whole_;  // too large for a stack
  std::size_t current_ = 0;

 public:
  Board& board = whole_->board;
  State& state = board.state;
  CpuState& cpu = state.cpu;

  Picture& picture() { return whole_->pictures[current_]; }
  std::array<Picture, 2>& pictures() { return whole_->pictures; }
  std::span<const std::uint8_t> row(int number) {
    return std::span(picture().pixel).subspan(static_cast<std::size_t>(number * kLinePixels), kLinePixels);
  }

  void write(int line, int x, unsigned reg, unsigned value) { write_at(line * kLineCycles + x, reg, value); }
  void write_at(int cycle, unsigned reg, unsigned value) {
    board.write_device(static_cast<std::uint16_t>(reg), static_cast<std::uint8_t>(value), cycle, true);
  }
  std::uint8_t read_at(int cycle, unsigned address, unsigned latch = 0) {
    return board.read_device(static_cast<std::uint16_t>(address), static_cast<std::uint8_t>(latch), cycle);
  }
  std::uint8_t read(int line, int x, unsigned address) { return read_at(line * kLineCycles + x, address); }

  // The same by the processor, with STA and LDA in RAM: what it does on its own way to the TIA is included.
  void store_at(int cycle, unsigned reg, unsigned value) {
    cpu.A = static_cast<std::uint8_t>(value);
    run_at(cycle, 0x85, reg);
  }
  std::uint8_t load_at(int cycle, unsigned reg) {
    run_at(cycle, 0xA5, reg);
    return cpu.A;
  }

  // The processor's view: plain memory, or a device.
  std::uint8_t see(unsigned address, int cycle = 0) {
    const std::uint8_t* page = board.map.page_of(static_cast<std::uint16_t>(address));
    return page != nullptr ? page[address & 0x3F] : read_at(cycle, address);
  }

  // Ends a step, as an instruction limit would: the frame goes on in the next one.
  void end_step() { board.end_step(); }
  void begin_step() { board.begin_step(picture()); }

  // Closes the frame at `cycle` and opens the next one in the other buffer.
  void next_frame(int cycle) {
    board.end_step();
    state.cycle = cycle;
    state.frame.lines = (3 * state.cycle - state.tia.origin) / kLineClocks;
    current_ ^= 1;
    state.frame.open = 1;
    board.open_frame();
    begin_step();
  }

  // A system reset in the middle of a frame: the frame stays open (tia.md, section 2).
  void reset_in_frame() {
    board.end_step();
    state.cycle = 0;
    state.tia = TiaState{};
    state.frame = FrameState{};
    state.frame.open = 1;
    for (Picture& buffer : pictures()) {
      buffer.pixel.fill(0);
      buffer.forget_lines();
    }
    board.map_memory();
    begin_step();
  }

  // Puts another moment's machine in place; the pictures stay.
  void restore(const State& saved) {
    state = saved;
    board.map_memory();
    begin_step();
  }

  void run_program(int instructions) {
    run(board, instructions);
    board.end_step();
    begin_step();
  }
};

}  // namespace racebeam::test
