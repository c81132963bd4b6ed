#include "emulator/cpu/cpu.hpp"

#include "emulator/cpu/addressing.hpp"
#include "emulator/cpu/followers.hpp"
#include "emulator/cpu/operations.hpp"

// Threaded dispatch: every handler ends with its own indirect jump, which processors predict far better than
// that of a switch. Before it, the handler tests for the opcodes that often follow its own (followers.hpp).
// Labels as values are an extension of g++ and clang.
#pragma GCC diagnostic ignored "-Wpedantic"

namespace racebeam {
namespace {

constexpr int kLoadCycles = 4, kBranchCycles = 2;  // of the two instructions of a timer loop

// The shape of an instruction, for each kind of access in opcodes.inc.
template <auto kMode, void (*kOperation)(Core&, std::uint8_t)>
RACEBEAM_INLINE void Read(Core& cpu) {
  const auto address = kMode(cpu);
  kOperation(cpu, cpu.read(address));
}

template <auto, void (*kOperation)(Core&, std::uint8_t)>
RACEBEAM_INLINE void Immediate(Core& cpu) {
  kOperation(cpu, cpu.fetch());
}

template <auto kMode, std::uint8_t (*kOperation)(Core&, std::uint16_t)>
RACEBEAM_INLINE void Write(Core& cpu) {
  const auto address = kMode(cpu);
  cpu.write(address, kOperation(cpu, address));
}

template <auto kMode, std::uint8_t (*kOperation)(Core&, std::uint8_t)>
RACEBEAM_INLINE void Modify(Core& cpu) {
  const auto address = kMode(cpu);
  cpu.write(address, kOperation(cpu, cpu.read(address)));
}

template <auto, std::uint8_t (*kOperation)(Core&, std::uint8_t)>
RACEBEAM_INLINE void Accumulator(Core& cpu) {
  cpu.A = kOperation(cpu, cpu.A);
}

template <auto, void (*kOperation)(Core&)>
RACEBEAM_INLINE void Implied(Core& cpu) {
  kOperation(cpu);
}

template <auto kMode, void (*kOperation)(Core&, std::uint16_t)>
RACEBEAM_INLINE void Jump(Core& cpu) {
  kOperation(cpu, kMode(cpu));
}

template <auto, bool (*kTaken)(Core&)>
RACEBEAM_INLINE void Branch(Core& cpu) {
  const auto offset = static_cast<std::int8_t>(cpu.fetch());
  if (!kTaken(cpu)) return;
  const int penalty = cpu.branch(offset);
  if (offset == kTimerLoopOffset) cpu.skip_timer_loop(kLoadCycles + kBranchCycles + penalty);
}

constexpr bool is_read(char first_letter_of_kind) { return first_letter_of_kind == 'R'; }

}  // namespace

void reset_cpu(Board& board) {
  board.state.cpu = CpuState{};
  Core cpu(board, 0, 0, false);
  const std::uint8_t low = cpu.read(0xFFFC);
  cpu.jump(static_cast<std::uint16_t>(low | cpu.read(0xFFFD) << 8));
  cpu.store_state();
}

void interpret(Board& board, std::int32_t instructions) {
  if (board.slot.scheme.observe != nullptr) return interpret_observed(board, instructions);
  interpret(board, instructions, instructions, false);
}

void interpret(Board& board, std::int32_t most, std::int32_t enough, bool stays) {
  if (board.state.cpu.jammed) return;
  board.stop = false;

  static constexpr void* kHandlers[256] = {
#define OP(code, operation, mode, access, cycles) &&op_##code,
#include "emulator/base/opcodes.inc"
#undef OP
  };

  Core cpu(board, most, enough, stays);

#define FOLLOWER(code) \
  if (often_follows(0x##code, kBefore) && next == 0x##code) goto op_##code;

#define NEXT(code)                                \
  do {                                            \
    constexpr std::uint8_t kBefore = 0x##code;    \
    if (cpu.at >= cpu.end) [[unlikely]]           \
      goto elsewhere;                             \
    const unsigned next = *Core::byte_at(cpu.at); \
    RACEBEAM_FOLLOWERS(FOLLOWER)                  \
    goto* kHandlers[next];                        \
  } while (false)

elsewhere:
  if (!cpu.locate()) goto done;
  goto* kHandlers[*Core::byte_at(cpu.at)];

// NOLINTBEGIN(bugprone-macro-parentheses): operation::name is a function
#define OP(code, name, mode_name, access, cycles)                     \
  op_##code : cpu.begin(0x##code, cycles);                            \
  access<mode::mode_name<is_read(#access[0])>, operation::name>(cpu); \
  NEXT(code);
// NOLINTEND(bugprone-macro-parentheses)
#include "emulator/base/opcodes.inc"
#undef OP
#undef NEXT
#undef FOLLOWER

done:
  cpu.store_state();
}

}  // namespace racebeam
