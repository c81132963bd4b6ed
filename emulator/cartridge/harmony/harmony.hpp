// The common part of the schemes of the Harmony cartridge, whose ARM replaces a chip: DPC+ and CDFJ. Each CPU
// cycle grants instructions to the ARM, and advances three voices. A follower finds the opcodes among the
// bytes that the CPU fetches (docs/spec/cartridges.md, 14).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "emulator/base/opcodes.hpp"
#include "emulator/cartridge/cartridge.hpp"

namespace racebeam::harmony {

// The instructions that the ARM may execute. A call that does not return ends when they are used up. A frame
// grants instructions for its first kCyclesOfFrame cycles only.
constexpr std::int32_t kCyclesOfFrame = 32768;
constexpr std::uint32_t kInstructionsPerCycle = 35, kMaxInstructions = kInstructionsPerCycle * kCyclesOfFrame;

// A sample lasts 3579575 / 3 / 20000 CPU cycles, which is 143183 / 2400.
constexpr unsigned kSampleParts = 143183, kPartsPerCycle = 2400;

constexpr std::uint16_t kAddressBits = 0x1FFF;

enum Bank { kShown, kFastFetch, kCalled };  // indices of CartridgeState::bank

inline bool is_valid(const CartridgeState& state, unsigned banks) {
  return state.bank[kShown] < banks && state.bank[kFastFetch] <= 1 && state.bank[kCalled] <= 1 &&
         banks_unused(state, kCalled + 1);
}

struct Voice {
  std::uint32_t frequency, phase;
};

struct Clock {
  std::array<Voice, 3> voice;
  std::uint32_t instructions = kMaxInstructions;  // that the ARM may still execute
  std::uint32_t into_sample;                      // parts of the present sample that have passed

  bool is_valid() const { return instructions <= kMaxInstructions && into_sample < kSampleParts; }

  void pass(State& machine, std::int32_t cycle) {
    const auto before = static_cast<std::int32_t>(machine.frame.cartridge_clock);
    machine.frame.cartridge_clock = static_cast<std::uint32_t>(cycle);
    if (cycle <= before) return;
    add_instructions(std::int64_t{std::min(cycle, kCyclesOfFrame)} - std::min(before, kCyclesOfFrame));
    const std::uint64_t parts =
        into_sample + kPartsPerCycle * static_cast<std::uint64_t>(std::int64_t{cycle} - before);
    into_sample = static_cast<std::uint32_t>(parts % kSampleParts);
    for (Voice& one : voice) one.phase += one.frequency * static_cast<std::uint32_t>(parts / kSampleParts);
  }

 private:
  void add_instructions(std::int64_t cycles) {
    const auto all = instructions + kInstructionsPerCycle * static_cast<std::uint64_t>(cycles);
    instructions = static_cast<std::uint32_t>(std::min<std::uint64_t>(kMaxInstructions, all));
  }
};

// Tells opcodes from operands among the bytes that the CPU reads. The bytes of an instruction are read one
// after the other. A byte elsewhere is an opcode, with one exception: the CPU reads the third byte of JSR
// when it jumps, and again when it returns.
struct Follower {
  std::uint16_t next;    // address of the byte after the last one
  std::uint8_t missing;  // bytes of the instruction that have not been read yet
  std::uint8_t opcode;

  bool is_valid() const { return next <= kAddressBits && missing <= 2; }

  // Follows a read. Returns whether the byte `value` at `address` is an operand of the instruction that has
  // begun. before: the byte at `address` - 2.
  bool continues(std::uint16_t address, std::uint8_t value, std::uint8_t before) {
    const auto place = static_cast<std::uint16_t>(address & kAddressBits);
    const bool behind = place == next, continued = behind && missing > 0;
    next = static_cast<std::uint16_t>((place + 1) & kAddressBits);
    if (continued) {
      --missing;
    } else if (behind ? opcode == kCall : before == kCall && !jumps()) {
      missing = 0;
      opcode = kNothing;
    } else {
      missing = static_cast<std::uint8_t>(kOpcodes[value].length - 1);
      opcode = value;
    }
    return continued;
  }

 private:
  static constexpr std::uint8_t kCall = 0x20, kNothing = 0xEA, kJump = 0x4C, kJumpIndirect = 0x6C;

  // Whether the instruction is JMP or a branch.
  bool jumps() const { return opcode == kJump || opcode == kJumpIndirect || (opcode & 0x1F) == 0x10; }
};

}  // namespace racebeam::harmony
