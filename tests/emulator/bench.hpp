// A test bench: a board whose registers can be accessed at chosen cycles, or whose CPU runs a few
// instructions at a time. Frames open and close as in Console::step().
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "emulator/board/board.hpp"
#include "emulator/cpu/cpu.hpp"
#include "emulator/tia/registers/registers.hpp"

namespace racebeam::test {

constexpr int kLineCycles = 76;

// The window of the examples in the specification.
inline Properties ntsc() {
  Properties properties;
  properties.format = Format::kNtsc;
  return properties;
}

struct Bench {
  static constexpr std::size_t kMaxRows = 320;  // of a picture that a reset has shifted down

  explicit Bench(Rom rom = Rom(4096, 0xEA), const Properties& properties = ntsc())
      : whole_(std::make_unique<Whole>(std::make_shared<const Rom>(std::move(rom)), properties)) {
    for (FrameBuffer& buffer : pictures()) buffer.make_room(kMaxRows);
    board.slot.scheme.reset(board.slot);
    board.map_memory();
    reset_cpu(board);
    state.frame.open = 1;
    board.open_frame();
  }

 private:
  // Every access in a step goes through here, so that end_step() can repeat it.
  std::uint8_t act(std::function<std::uint8_t(Bench&)> action) {
    if (step_.empty()) {
      at_begin_ = state;
      board.begin_step(picture(), &pictures()[current_ ^ 1], whole_->log);
    }
    step_.push_back(std::move(action));
    return step_.back()(*this);
  }

  void run_at(int cycle, unsigned opcode, unsigned operand) {
    state.riot.ram[0] = static_cast<std::uint8_t>(opcode);
    state.riot.ram[1] = static_cast<std::uint8_t>(operand);
    cpu.PC = 0x80;
    state.cycle = cycle - 3;
    racebeam::interpret(board, 1);
  }

  struct Whole {
    Whole(std::shared_ptr<const Rom> rom, const Properties& properties) : board(std::move(rom), properties) {}
    Board board;
    std::array<FrameBuffer, 2> pictures;
    WriteLog log;
  };
  std::unique_ptr<Whole> whole_;  // too large for a stack
  std::size_t current_ = 0;
  State at_begin_;                                         // of the step
  std::vector<std::function<std::uint8_t(Bench&)>> step_;  // the accesses of the step

 public:
  Board& board = whole_->board;
  State& state = board.state;
  CpuState& cpu = state.cpu;

  FrameBuffer& picture() { return whole_->pictures[current_]; }
  std::array<FrameBuffer, 2>& pictures() { return whole_->pictures; }
  std::span<const std::uint8_t> row(int number) {
    return picture().pixels().subspan(static_cast<std::size_t>(number) * kLinePixels, kLinePixels);
  }

  void write(int line, int x, unsigned reg, unsigned value) { write_at(line * kLineCycles + x, reg, value); }
  void write_at(int cycle, unsigned reg, unsigned value) {
    act([=](Bench& bench) {
      bench.state.cycle = std::max(bench.state.cycle, cycle);
      bench.board.write_device(static_cast<std::uint16_t>(reg), static_cast<std::uint8_t>(value), cycle,
                               true);
      return std::uint8_t{0};
    });
  }
  std::uint8_t read_at(int cycle, unsigned address, unsigned latch = 0) {
    return act([=](Bench& bench) {
      return bench.board.read_device(static_cast<std::uint16_t>(address), static_cast<std::uint8_t>(latch),
                                     cycle);
    });
  }
  std::uint8_t read(int line, int x, unsigned address) { return read_at(line * kLineCycles + x, address); }

  // The CPU accesses it, with STA and LDA in RAM, so that the CPU's path to the TIA is included.
  void store_at(int cycle, unsigned reg, unsigned value) {
    act([=](Bench& bench) {
      bench.cpu.A = static_cast<std::uint8_t>(value);
      bench.run_at(cycle, 0x85, reg);
      return bench.cpu.A;
    });
  }
  std::uint8_t load_at(int cycle, unsigned reg) {
    return act([=](Bench& bench) {
      bench.run_at(cycle, 0xA5, reg);
      return bench.cpu.A;
    });
  }

  // A read as the CPU sees it: plain memory, or a device.
  std::uint8_t see(unsigned address, int cycle = 0) {
    const std::uint8_t* page = board.map.page_of(static_cast<std::uint16_t>(address));
    return page != nullptr ? page[address & 0x3F] : read_at(cycle, address);
  }

  // Ends a step as the instruction limit does: the frame continues in the next step, which begins with the
  // next access. Where Console::step() would run the CPU again, all accesses are repeated.
  void end_step() {
    if (step_.empty()) return;
    board.end_step();
    if (board.needs_exact_step()) {
      state = at_begin_;
      board.map_memory();
      board.begin_step(picture(), &pictures()[current_ ^ 1], whole_->log, RenderMode::kExact);
      for (const auto& action : step_) action(*this);
      board.end_step();
    }
    step_.clear();
  }

  // Closes the frame at `cycle` and opens the next one in the other buffer.
  void next_frame(int cycle) {
    end_step();
    state.cycle = cycle;
    state.frame.lines = (3 * state.cycle - state.tia.origin) / kLineClocks;
    current_ ^= 1;
    state.frame.open = 1;
    board.open_frame();
  }

  // A system reset in the middle of a frame: the frame stays open (docs/spec/tia.md, 2).
  void reset_in_frame() {
    end_step();
    state.cycle = 0;
    state.tia = TiaState{};
    state.frame = FrameState{};
    state.frame.open = 1;
    for (FrameBuffer& buffer : pictures()) {
      buffer.blank();
      buffer.make_room(kMaxRows);
    }
    board.map_memory();
  }

  // Restores a machine of another moment; the pictures stay.
  void restore(const State& saved) { board.restore(saved); }

  void run(int instructions) {
    act([=](Bench& bench) {
      racebeam::interpret(bench.board, instructions);
      return std::uint8_t{0};
    });
  }

  void run_program(int instructions) {
    run(instructions);
    end_step();
  }
};

}  // namespace racebeam::test
