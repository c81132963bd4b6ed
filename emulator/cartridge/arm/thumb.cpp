// The 19 formats of Thumb instructions, numbered as in the ARM7TDMI's data sheet. A handler executes one
// instruction; a table finds it by the upper ten bits. Operations have the names of ARM's assembler language.
#include "emulator/cartridge/arm/thumb.hpp"

#include <algorithm>
#include <bit>

namespace racebeam::arm {
namespace {

using Word = std::uint32_t;
using Code = std::uint32_t;  // an instruction; 16 bits

constexpr Word kHalf = 2;              // bytes of an instruction
constexpr unsigned kLowRegisters = 8;  // R0 to R7, which most instructions name with 3 bits
constexpr Code kWithLrOrPc = 0x100;    // PUSH and POP: one more register
constexpr Word kAllButThumbBit = ~Word{1};

// While an instruction is executed, r[kPc] is its address plus 4.
struct Core : Registers {
  const Memory memory;
  std::uint32_t left;  // instructions
  Word next;           // address of the next one
  bool runs = true;
  Ending ending = Ending::kOutOfTime;

  void end(Ending how) {
    ending = how;
    runs = false;
  }
  void spend(int instructions) { left -= std::min(left, static_cast<std::uint32_t>(instructions)); }
  void jump(Word address) { next = address & kAllButThumbBit; }
};

// The fields of an instruction.
constexpr unsigned field(Code code, unsigned bit, unsigned size) { return code >> bit & ((1U << size) - 1); }

constexpr Word signed_field(Code code, unsigned size) {
  return field(code, 0, size) - (field(code, size - 1, 1) << size);
}

template <unsigned kBit>
Word& low_register(Core& core, Code code) {
  return core.r[field(code, kBit, 3)];
}

Word set_nz(Core& core, Word result) {
  core.n = result >> 31 != 0;
  core.z = result == 0;
  return result;
}

// The operations. Each sets the flags, and returns the result. add_with_carry() sets all four, the logical
// ones set N and Z, and shifts set N, Z and C.

Word add_with_carry(Core& core, Word a, Word b, Word carry) {
  const std::uint64_t whole = std::uint64_t{a} + b + carry;
  const auto result = static_cast<Word>(whole);
  core.c = whole >> 32 != 0;
  core.v = (~(a ^ b) & (a ^ result)) >> 31 != 0;
  return set_nz(core, result);
}

Word add(Core& core, Word a, Word b) { return add_with_carry(core, a, b, 0); }
Word adc(Core& core, Word a, Word b) { return add_with_carry(core, a, b, core.c); }
Word sub(Core& core, Word a, Word b) { return add_with_carry(core, a, ~b, 1); }
Word sbc(Core& core, Word a, Word b) { return add_with_carry(core, a, ~b, core.c); }
Word neg(Core& core, Word, Word b) { return sub(core, 0, b); }
Word mul(Core& core, Word a, Word b) { return set_nz(core, a * b); }
Word mov(Core& core, Word, Word b) { return set_nz(core, b); }
Word mvn(Core& core, Word, Word b) { return set_nz(core, ~b); }
Word and_(Core& core, Word a, Word b) { return set_nz(core, a & b); }
Word orr(Core& core, Word a, Word b) { return set_nz(core, a | b); }
Word eor(Core& core, Word a, Word b) { return set_nz(core, a ^ b); }
Word bic(Core& core, Word a, Word b) { return set_nz(core, a & ~b); }

// Shifts use the low byte of the second operand. A shift by 0 does not change C.
Word lsl(Core& core, Word a, Word b) {
  const unsigned by = b & 0xFF;
  if (by != 0) core.c = by <= 32 && (a >> (32 - by) & 1) != 0;
  return set_nz(core, by < 32 ? a << by : 0);
}

Word lsr(Core& core, Word a, Word b) {
  const unsigned by = b & 0xFF;
  if (by != 0) core.c = by <= 32 && (a >> (by - 1) & 1) != 0;
  return set_nz(core, by < 32 ? a >> by : 0);
}

Word asr(Core& core, Word a, Word b) {
  const unsigned by = std::min(b & 0xFF, Word{32});
  const auto whole = std::int64_t{static_cast<std::int32_t>(a)};
  if (by != 0) core.c = (whole >> (by - 1) & 1) != 0;
  return set_nz(core, static_cast<Word>(whole >> by));
}

Word ror(Core& core, Word a, Word b) {
  const Word result = std::rotr(a, static_cast<int>(b & 31));
  if ((b & 0xFF) != 0) core.c = result >> 31 != 0;
  return set_nz(core, result);
}

// Formats 1 to 4: arithmetic with low registers. kZero: the distance that an immediate 0 of a shift stands
// for.

template <auto kOperation, unsigned kZero>
void op_shift(Core& core, Code code) {
  const unsigned by = field(code, 6, 5);
  low_register<0>(core, code) = kOperation(core, low_register<3>(core, code), by == 0 ? kZero : by);
}

template <auto kOperation>
void op_registers(Core& core, Code code) {
  low_register<0>(core, code) = kOperation(core, low_register<3>(core, code), low_register<6>(core, code));
}

template <auto kOperation>
void op_immediate_3(Core& core, Code code) {
  low_register<0>(core, code) = kOperation(core, low_register<3>(core, code), field(code, 6, 3));
}

template <auto kOperation>
void op_immediate_8(Core& core, Code code) {
  Word& target = low_register<8>(core, code);
  target = kOperation(core, target, field(code, 0, 8));
}

void compare_immediate(Core& core, Code code) { sub(core, low_register<8>(core, code), field(code, 0, 8)); }

template <auto kOperation>
void op_register(Core& core, Code code) {
  Word& target = low_register<0>(core, code);
  target = kOperation(core, target, low_register<3>(core, code));
}

template <auto kOperation>
void op_flags(Core& core, Code code) {
  kOperation(core, low_register<0>(core, code), low_register<3>(core, code));
}

// Format 5: high and low registers. Only CMP sets flags.

Word high_source(const Core& core, Code code) { return core.r[field(code, 3, 4)]; }
unsigned high_target(Code code) { return field(code, 0, 3) | field(code, 7, 1) << 3; }

void set_register(Core& core, unsigned target, Word value) {
  if (target == kPc)
    core.jump(value);
  else
    core.r[target] = value;
}

void add_high(Core& core, Code code) {
  set_register(core, high_target(code), core.r[high_target(code)] + high_source(core, code));
}
void compare_high(Core& core, Code code) { sub(core, core.r[high_target(code)], high_source(core, code)); }
void move_high(Core& core, Code code) { set_register(core, high_target(code), high_source(core, code)); }

void branch_exchange(Core& core, Code code) {
  const Word address = high_source(core, code);
  if ((address & 1) == 0) core.end(Ending::kReturned);
  core.jump(address);
}

// Formats 6 to 11: loads and stores of one number.

Word load_word(const Core& core, Word address) {
  return std::rotr(core.memory.load<Word>(address), static_cast<int>(address % 4 * 8));
}

template <class Number>
Word load(const Core& core, Word address) {
  return static_cast<Word>(std::int32_t{core.memory.load<Number>(address)});
}

template <class Number>
void store(const Core& core, Word address, Word value) {
  core.memory.store(address, static_cast<Number>(value));
}

Word register_offset(Core& core, Code code) {
  return low_register<3>(core, code) + low_register<6>(core, code);
}

template <unsigned kSize>
Word immediate_offset(Core& core, Code code) {
  return low_register<3>(core, code) + field(code, 6, 5) * kSize;
}

Word sp_relative(Core& core, Code code) { return core.r[kSp] + field(code, 0, 8) * 4; }
Word pc_relative(Core& core, Code code) { return (core.r[kPc] & ~Word{3}) + field(code, 0, 8) * 4; }

template <auto kLoad, auto kPlace, unsigned kTarget = 0>
void load_from(Core& core, Code code) {
  low_register<kTarget>(core, code) = kLoad(core, kPlace(core, code));
}

template <auto kStore, auto kPlace, unsigned kSource = 0>
void store_to(Core& core, Code code) {
  kStore(core, kPlace(core, code), low_register<kSource>(core, code));
}

// Formats 12 and 13: addresses in the code or on the stack.

template <auto kPlace>
void load_address(Core& core, Code code) {
  low_register<8>(core, code) = kPlace(core, code);
}

void adjust_sp(Core& core, Code code) {
  const Word distance = field(code, 0, 7) * 4;
  core.r[kSp] += field(code, 7, 1) != 0 ? Word{0} - distance : distance;
}

// Formats 14 and 15: several registers, the lowest one at the lowest address. Each register counts as an
// instruction (run()).

Word store_list(Core& core, Code list, Word address) {
  core.spend(std::popcount(list & 0xFF));
  for (unsigned number = 0; number < kLowRegisters; ++number) {
    if (field(list, number, 1) == 0) continue;
    core.memory.store(address, core.r[number]);
    address += 4;
  }
  return address;
}

Word load_list(Core& core, Code list, Word address) {
  core.spend(std::popcount(list & 0xFF));
  for (unsigned number = 0; number < kLowRegisters; ++number) {
    if (field(list, number, 1) == 0) continue;
    core.r[number] = core.memory.load<Word>(address);
    address += 4;
  }
  return address;
}

void push(Core& core, Code code) {
  const Code list = field(code, 0, 9);
  if (list == 0) return core.end(Ending::kFault);
  core.r[kSp] -= static_cast<Word>(std::popcount(list)) * 4;
  const Word end = store_list(core, list, core.r[kSp]);
  if ((list & kWithLrOrPc) != 0) core.memory.store(end, core.r[kLr]);
}

void pop(Core& core, Code code) {
  const Code list = field(code, 0, 9);
  if (list == 0) return core.end(Ending::kFault);
  Word end = load_list(core, list, core.r[kSp]);
  if ((list & kWithLrOrPc) != 0) {
    core.jump(core.memory.load<Word>(end));
    end += 4;
  }
  core.r[kSp] = end;
}

void store_multiple(Core& core, Code code) {
  if (field(code, 0, 8) == 0) return core.end(Ending::kFault);
  Word& base = low_register<8>(core, code);
  base = store_list(core, code, base);
}

// If the base is in the list, it keeps the loaded value.
void load_multiple(Core& core, Code code) {
  if (field(code, 0, 8) == 0) return core.end(Ending::kFault);
  Word& base = low_register<8>(core, code);
  const Word end = load_list(core, code, base);
  if (field(code, field(code, 8, 3), 1) == 0) base = end;
}

// Formats 16 to 19: branches.

bool holds(const Core& core, unsigned condition) {
  const auto either = [&] {
    switch (condition >> 1) {
      case 0: return core.z;
      case 1: return core.c;
      case 2: return core.n;
      case 3: return core.v;
      case 4: return core.c && !core.z;
      case 5: return core.n == core.v;
      default: return core.n == core.v && !core.z;
    }
  };
  return either() != ((condition & 1) != 0);
}

void branch_if(Core& core, Code code) {
  if (holds(core, field(code, 8, 4))) core.jump(core.r[kPc] + signed_field(code, 8) * kHalf);
}

void branch(Core& core, Code code) { core.jump(core.r[kPc] + signed_field(code, 11) * kHalf); }

// BL consists of two instructions. The first one leaves the upper part of the target in LR.
void bl_prefix(Core& core, Code code) { core.r[kLr] = core.r[kPc] + (signed_field(code, 11) << 12); }

void bl_suffix(Core& core, Code code) {
  const Word target = core.r[kLr] + field(code, 0, 11) * kHalf;
  core.r[kLr] = (core.r[kPc] - kHalf) | 1;
  core.jump(target);
}

void undefined(Core& core, Code) { core.end(Ending::kFault); }

using Handler = void (*)(Core&, Code);

// An instruction has the format of the first row in which its bits in `mask` are `bits`.
struct Format {
  Code mask, bits;
  Handler handler;
};

// clang-format off
constexpr Format kFormats[] = {
    {0xF800, 0x0000, op_shift<lsl, 0>},                                     // 1: LSL
    {0xF800, 0x0800, op_shift<lsr, 32>},                                    // LSR
    {0xF800, 0x1000, op_shift<asr, 32>},                                    // ASR
    {0xFE00, 0x1800, op_registers<add>},                                    // 2: ADD
    {0xFE00, 0x1A00, op_registers<sub>},                                    // SUB
    {0xFE00, 0x1C00, op_immediate_3<add>},                                  // ADD
    {0xFE00, 0x1E00, op_immediate_3<sub>},                                  // SUB
    {0xF800, 0x2000, op_immediate_8<mov>},                                  // 3: MOV
    {0xF800, 0x2800, compare_immediate},                                    // CMP
    {0xF800, 0x3000, op_immediate_8<add>},                                  // ADD
    {0xF800, 0x3800, op_immediate_8<sub>},                                  // SUB
    {0xFFC0, 0x4000, op_register<and_>},                                    // 4: AND
    {0xFFC0, 0x4040, op_register<eor>},                                     // EOR
    {0xFFC0, 0x4080, op_register<lsl>},                                     // LSL
    {0xFFC0, 0x40C0, op_register<lsr>},                                     // LSR
    {0xFFC0, 0x4100, op_register<asr>},                                     // ASR
    {0xFFC0, 0x4140, op_register<adc>},                                     // ADC
    {0xFFC0, 0x4180, op_register<sbc>},                                     // SBC
    {0xFFC0, 0x41C0, op_register<ror>},                                     // ROR
    {0xFFC0, 0x4200, op_flags<and_>},                                       // TST
    {0xFFC0, 0x4240, op_register<neg>},                                     // NEG
    {0xFFC0, 0x4280, op_flags<sub>},                                        // CMP
    {0xFFC0, 0x42C0, op_flags<add>},                                        // CMN
    {0xFFC0, 0x4300, op_register<orr>},                                     // ORR
    {0xFFC0, 0x4340, op_register<mul>},                                     // MUL
    {0xFFC0, 0x4380, op_register<bic>},                                     // BIC
    {0xFFC0, 0x43C0, op_register<mvn>},                                     // MVN
    {0xFF00, 0x4400, add_high},                                             // 5: ADD
    {0xFF00, 0x4500, compare_high},                                         // CMP
    {0xFF00, 0x4600, move_high},                                            // MOV
    {0xFF80, 0x4700, branch_exchange},                                      // BX
    {0xF800, 0x4800, load_from<load_word, pc_relative, 8>},                 // 6: LDR
    {0xFE00, 0x5000, store_to<store<std::uint32_t>, register_offset>},      // 7: STR
    {0xFE00, 0x5200, store_to<store<std::uint16_t>, register_offset>},      // 8: STRH
    {0xFE00, 0x5400, store_to<store<std::uint8_t>, register_offset>},       // 7: STRB
    {0xFE00, 0x5600, load_from<load<std::int8_t>, register_offset>},        // 8: LDRSB
    {0xFE00, 0x5800, load_from<load_word, register_offset>},                // 7: LDR
    {0xFE00, 0x5A00, load_from<load<std::uint16_t>, register_offset>},      // 8: LDRH
    {0xFE00, 0x5C00, load_from<load<std::uint8_t>, register_offset>},       // 7: LDRB
    {0xFE00, 0x5E00, load_from<load<std::int16_t>, register_offset>},       // 8: LDRSH
    {0xF800, 0x6000, store_to<store<std::uint32_t>, immediate_offset<4>>},  // 9: STR
    {0xF800, 0x6800, load_from<load_word, immediate_offset<4>>},            // LDR
    {0xF800, 0x7000, store_to<store<std::uint8_t>, immediate_offset<1>>},   // STRB
    {0xF800, 0x7800, load_from<load<std::uint8_t>, immediate_offset<1>>},   // LDRB
    {0xF800, 0x8000, store_to<store<std::uint16_t>, immediate_offset<2>>},  // 10: STRH
    {0xF800, 0x8800, load_from<load<std::uint16_t>, immediate_offset<2>>},  // LDRH
    {0xF800, 0x9000, store_to<store<std::uint32_t>, sp_relative, 8>},       // 11: STR
    {0xF800, 0x9800, load_from<load_word, sp_relative, 8>},                 // LDR
    {0xF800, 0xA000, load_address<pc_relative>},                            // 12: ADD
    {0xF800, 0xA800, load_address<sp_relative>},                            // ADD
    {0xFF00, 0xB000, adjust_sp},                                            // 13: ADD
    {0xFE00, 0xB400, push},                                                 // 14: PUSH
    {0xFE00, 0xBC00, pop},                                                  // POP
    {0xF800, 0xC000, store_multiple},                                       // 15: STMIA
    {0xF800, 0xC800, load_multiple},                                        // LDMIA
    {0xFE00, 0xDE00, undefined},                                            // 17: SWI, undefined Bcc
    {0xF000, 0xD000, branch_if},                                            // 16: Bcc
    {0xF800, 0xE000, branch},                                               // 18: B
    {0xF800, 0xF000, bl_prefix},                                            // 19: BL, first half
    {0xF800, 0xF800, bl_suffix},                                            // BL, second half
    {0x0000, 0x0000, undefined},
};
// clang-format on

constexpr unsigned kUnusedBits = 6;  // all masks are 0 in these lower bits

constexpr auto kHandlers = [] {
  std::array<Handler, (0x10000 >> kUnusedBits)> handlers{};
  for (Code upper = 0; upper < handlers.size(); ++upper) {
    const Format* format = kFormats;
    while ((upper << kUnusedBits & format->mask) != format->bits) ++format;
    handlers[upper] = format->handler;
  }
  return handlers;
}();

void execute_next(Core& core) {
  --core.left;
  const std::uint8_t* bytes = core.memory.find(core.next, kHalf);
  if (bytes == nullptr || core.next < core.memory.code_begin) return core.end(Ending::kFault);
  const Code code = bytes[0] | Code{bytes[1]} << 8;
  core.r[kPc] = core.next + 2 * kHalf;
  core.next += kHalf;
  kHandlers[code >> kUnusedBits](core, code);
}

}  // namespace

Ending run(const Memory& memory, Registers& registers, std::uint32_t& left) {
  Core core{registers, memory, left, registers.r[kPc]};
  while (core.runs && core.left > 0) execute_next(core);
  registers = core;
  registers.r[kPc] = core.next;
  left = core.left;
  return core.ending;
}

}  // namespace racebeam::arm
