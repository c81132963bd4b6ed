// The 19 formats of Thumb instructions. A handler executes one; a table finds it by the upper ten bits.
#include "emulator/cartridge/arm/thumb.hpp"

#include <algorithm>
#include <bit>

namespace racebeam::arm {
namespace {

using Word = std::uint32_t;
using Code = std::uint32_t;  // an instruction; 16 bits

constexpr Word kHalf = 2;              // bytes of an instruction
constexpr unsigned kLowRegisters = 8;  // those that most instructions have 3 bits for
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

Word with_flags(Core& core, Word result) {
  core.n = result >> 31 != 0;
  core.z = result == 0;
  return result;
}

// The operations. Each sets the flags, and returns the result.

Word sum(Core& core, Word a, Word b, Word carry) {
  const std::uint64_t whole = std::uint64_t{a} + b + carry;
  const auto result = static_cast<Word>(whole);
  core.c = whole >> 32 != 0;
  core.v = (~(a ^ b) & (a ^ result)) >> 31 != 0;
  return with_flags(core, result);
}

Word add(Core& core, Word a, Word b) { return sum(core, a, b, 0); }
Word add_carry(Core& core, Word a, Word b) { return sum(core, a, b, core.c); }
Word subtract(Core& core, Word a, Word b) { return sum(core, a, ~b, 1); }
Word subtract_carry(Core& core, Word a, Word b) { return sum(core, a, ~b, core.c); }
Word negate(Core& core, Word, Word b) { return subtract(core, 0, b); }
Word multiply(Core& core, Word a, Word b) { return with_flags(core, a * b); }
Word take(Core& core, Word, Word b) { return with_flags(core, b); }
Word take_inverted(Core& core, Word, Word b) { return with_flags(core, ~b); }
Word bits_of_both(Core& core, Word a, Word b) { return with_flags(core, a & b); }
Word bits_of_either(Core& core, Word a, Word b) { return with_flags(core, a | b); }
Word bits_of_one(Core& core, Word a, Word b) { return with_flags(core, a ^ b); }
Word bits_cleared(Core& core, Word a, Word b) { return with_flags(core, a & ~b); }

// Shifts use the low byte of the second operand. By 0 they leave the carry.
Word shift_left(Core& core, Word a, Word b) {
  const unsigned by = b & 0xFF;
  if (by != 0) core.c = by <= 32 && (a >> (32 - by) & 1) != 0;
  return with_flags(core, by < 32 ? a << by : 0);
}

Word shift_right(Core& core, Word a, Word b) {
  const unsigned by = b & 0xFF;
  if (by != 0) core.c = by <= 32 && (a >> (by - 1) & 1) != 0;
  return with_flags(core, by < 32 ? a >> by : 0);
}

Word shift_right_signed(Core& core, Word a, Word b) {
  const unsigned by = std::min(b & 0xFF, Word{32});
  const auto whole = std::int64_t{static_cast<std::int32_t>(a)};
  if (by != 0) core.c = (whole >> (by - 1) & 1) != 0;
  return with_flags(core, static_cast<Word>(whole >> by));
}

Word rotate_right(Core& core, Word a, Word b) {
  const Word result = std::rotr(a, static_cast<int>(b & 31));
  if ((b & 0xFF) != 0) core.c = result >> 31 != 0;
  return with_flags(core, result);
}

// Formats 1 to 4: arithmetic with low registers. kZero is the number of bits that a shift by 0 means.

template <auto kOperation, unsigned kZero>
void shift_by_number(Core& core, Code code) {
  const unsigned by = field(code, 6, 5);
  low_register<0>(core, code) = kOperation(core, low_register<3>(core, code), by == 0 ? kZero : by);
}

template <auto kOperation>
void with_third_register(Core& core, Code code) {
  low_register<0>(core, code) = kOperation(core, low_register<3>(core, code), low_register<6>(core, code));
}

template <auto kOperation>
void with_small_number(Core& core, Code code) {
  low_register<0>(core, code) = kOperation(core, low_register<3>(core, code), field(code, 6, 3));
}

template <auto kOperation>
void with_number(Core& core, Code code) {
  Word& target = low_register<8>(core, code);
  target = kOperation(core, target, field(code, 0, 8));
}

void compare_with_number(Core& core, Code code) {
  subtract(core, low_register<8>(core, code), field(code, 0, 8));
}

template <auto kOperation>
void with_register(Core& core, Code code) {
  Word& target = low_register<0>(core, code);
  target = kOperation(core, target, low_register<3>(core, code));
}

template <auto kOperation>
void only_flags(Core& core, Code code) {
  kOperation(core, low_register<0>(core, code), low_register<3>(core, code));
}

// Format 5: any register, without flags.

Word any_source(const Core& core, Code code) { return core.r[field(code, 3, 4)]; }
unsigned any_target(Code code) { return field(code, 0, 3) | field(code, 7, 1) << 3; }

void put(Core& core, unsigned target, Word value) {
  if (target == kPc)
    core.jump(value);
  else
    core.r[target] = value;
}

void add_any(Core& core, Code code) {
  put(core, any_target(code), core.r[any_target(code)] + any_source(core, code));
}
void compare_any(Core& core, Code code) { subtract(core, core.r[any_target(code)], any_source(core, code)); }
void move_any(Core& core, Code code) { put(core, any_target(code), any_source(core, code)); }

void branch_exchange(Core& core, Code code) {
  const Word address = any_source(core, code);
  if ((address & 1) == 0) core.end(Ending::kReturned);
  core.jump(address);
}

// Formats 6 to 11: one number of memory.

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

Word indexed_place(Core& core, Code code) {
  return low_register<3>(core, code) + low_register<6>(core, code);
}

template <unsigned kSize>
Word near_place(Core& core, Code code) {
  return low_register<3>(core, code) + field(code, 6, 5) * kSize;
}

Word stack_place(Core& core, Code code) { return core.r[kSp] + field(code, 0, 8) * 4; }
Word code_place(Core& core, Code code) { return (core.r[kPc] & ~Word{3}) + field(code, 0, 8) * 4; }

template <auto kLoad, auto kPlace, unsigned kTarget = 0>
void load_from(Core& core, Code code) {
  low_register<kTarget>(core, code) = kLoad(core, kPlace(core, code));
}

template <auto kStore, auto kPlace, unsigned kSource = 0>
void store_to(Core& core, Code code) {
  kStore(core, kPlace(core, code), low_register<kSource>(core, code));
}

// Formats 12 and 13: addresses.

template <auto kPlace>
void take_address(Core& core, Code code) {
  low_register<8>(core, code) = kPlace(core, code);
}

void move_stack(Core& core, Code code) {
  const Word distance = field(code, 0, 7) * 4;
  core.r[kSp] += field(code, 7, 1) != 0 ? Word{0} - distance : distance;
}

// Formats 14 and 15: several registers, the lowest one at the lowest address. Each takes as long as an
// instruction.

Word store_listed(Core& core, Code list, Word address) {
  core.spend(std::popcount(list & 0xFF));
  for (unsigned number = 0; number < kLowRegisters; ++number) {
    if (field(list, number, 1) == 0) continue;
    core.memory.store(address, core.r[number]);
    address += 4;
  }
  return address;
}

Word load_listed(Core& core, Code list, Word address) {
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
  const Word end = store_listed(core, list, core.r[kSp]);
  if ((list & kWithLrOrPc) != 0) core.memory.store(end, core.r[kLr]);
}

void pop(Core& core, Code code) {
  const Code list = field(code, 0, 9);
  if (list == 0) return core.end(Ending::kFault);
  Word end = load_listed(core, list, core.r[kSp]);
  if ((list & kWithLrOrPc) != 0) {
    core.jump(core.memory.load<Word>(end));
    end += 4;
  }
  core.r[kSp] = end;
}

void store_multiple(Core& core, Code code) {
  if (field(code, 0, 8) == 0) return core.end(Ending::kFault);
  Word& base = low_register<8>(core, code);
  base = store_listed(core, code, base);
}

// A base that is in the list keeps what was loaded.
void load_multiple(Core& core, Code code) {
  if (field(code, 0, 8) == 0) return core.end(Ending::kFault);
  Word& base = low_register<8>(core, code);
  const Word end = load_listed(core, code, base);
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

// BL has two instructions. The first one leaves the upper part of the target in LR.
void begin_call(Core& core, Code code) { core.r[kLr] = core.r[kPc] + (signed_field(code, 11) << 12); }

void end_call(Core& core, Code code) {
  const Word target = core.r[kLr] + field(code, 0, 11) * kHalf;
  core.r[kLr] = (core.r[kPc] - kHalf) | 1;
  core.jump(target);
}

void undefined(Core& core, Code) { core.end(Ending::kFault); }

using Handler = void (*)(Core&, Code);

// The instructions whose upper bits, those of `mask`, are `bits`. The first row that fits counts.
struct Format {
  Code mask, bits;
  Handler handler;
};

// clang-format off
constexpr Format kFormats[] = {
    {0xF800, 0x0000, shift_by_number<shift_left, 0>},            // 1
    {0xF800, 0x0800, shift_by_number<shift_right, 32>},
    {0xF800, 0x1000, shift_by_number<shift_right_signed, 32>},
    {0xFE00, 0x1800, with_third_register<add>},                  // 2
    {0xFE00, 0x1A00, with_third_register<subtract>},
    {0xFE00, 0x1C00, with_small_number<add>},
    {0xFE00, 0x1E00, with_small_number<subtract>},
    {0xF800, 0x2000, with_number<take>},                         // 3
    {0xF800, 0x2800, compare_with_number},
    {0xF800, 0x3000, with_number<add>},
    {0xF800, 0x3800, with_number<subtract>},
    {0xFFC0, 0x4000, with_register<bits_of_both>},               // 4: AND
    {0xFFC0, 0x4040, with_register<bits_of_one>},                // EOR
    {0xFFC0, 0x4080, with_register<shift_left>},                 // LSL
    {0xFFC0, 0x40C0, with_register<shift_right>},                // LSR
    {0xFFC0, 0x4100, with_register<shift_right_signed>},         // ASR
    {0xFFC0, 0x4140, with_register<add_carry>},                  // ADC
    {0xFFC0, 0x4180, with_register<subtract_carry>},             // SBC
    {0xFFC0, 0x41C0, with_register<rotate_right>},               // ROR
    {0xFFC0, 0x4200, only_flags<bits_of_both>},                  // TST
    {0xFFC0, 0x4240, with_register<negate>},                     // NEG
    {0xFFC0, 0x4280, only_flags<subtract>},                      // CMP
    {0xFFC0, 0x42C0, only_flags<add>},                           // CMN
    {0xFFC0, 0x4300, with_register<bits_of_either>},             // ORR
    {0xFFC0, 0x4340, with_register<multiply>},                   // MUL
    {0xFFC0, 0x4380, with_register<bits_cleared>},               // BIC
    {0xFFC0, 0x43C0, with_register<take_inverted>},              // MVN
    {0xFF00, 0x4400, add_any},                                   // 5
    {0xFF00, 0x4500, compare_any},
    {0xFF00, 0x4600, move_any},
    {0xFF80, 0x4700, branch_exchange},
    {0xF800, 0x4800, load_from<load_word, code_place, 8>},       // 6
    {0xFE00, 0x5000, store_to<store<std::uint32_t>, indexed_place>},  // 7 and 8
    {0xFE00, 0x5200, store_to<store<std::uint16_t>, indexed_place>},
    {0xFE00, 0x5400, store_to<store<std::uint8_t>, indexed_place>},
    {0xFE00, 0x5600, load_from<load<std::int8_t>, indexed_place>},
    {0xFE00, 0x5800, load_from<load_word, indexed_place>},
    {0xFE00, 0x5A00, load_from<load<std::uint16_t>, indexed_place>},
    {0xFE00, 0x5C00, load_from<load<std::uint8_t>, indexed_place>},
    {0xFE00, 0x5E00, load_from<load<std::int16_t>, indexed_place>},
    {0xF800, 0x6000, store_to<store<std::uint32_t>, near_place<4>>},  // 9
    {0xF800, 0x6800, load_from<load_word, near_place<4>>},
    {0xF800, 0x7000, store_to<store<std::uint8_t>, near_place<1>>},
    {0xF800, 0x7800, load_from<load<std::uint8_t>, near_place<1>>},
    {0xF800, 0x8000, store_to<store<std::uint16_t>, near_place<2>>},  // 10
    {0xF800, 0x8800, load_from<load<std::uint16_t>, near_place<2>>},
    {0xF800, 0x9000, store_to<store<std::uint32_t>, stack_place, 8>},  // 11
    {0xF800, 0x9800, load_from<load_word, stack_place, 8>},
    {0xF800, 0xA000, take_address<code_place>},                  // 12
    {0xF800, 0xA800, take_address<stack_place>},
    {0xFF00, 0xB000, move_stack},                                // 13
    {0xFE00, 0xB400, push},                                      // 14
    {0xFE00, 0xBC00, pop},
    {0xF800, 0xC000, store_multiple},                            // 15
    {0xF800, 0xC800, load_multiple},
    {0xFE00, 0xDE00, undefined},                                 // 17: SWI, and the condition before it
    {0xF000, 0xD000, branch_if},                                 // 16
    {0xF800, 0xE000, branch},                                    // 18
    {0xF800, 0xF000, begin_call},                                // 19
    {0xF800, 0xF800, end_call},
    {0x0000, 0x0000, undefined},
};
// clang-format on

constexpr unsigned kUnusedBits = 6;  // no mask has one of the lower bits

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
