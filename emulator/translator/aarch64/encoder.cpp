#include "emulator/translator/aarch64/encoder.hpp"

#include <bit>

namespace racebeam::translator::aarch64 {
namespace {

constexpr std::uint32_t kWide = 1U << 31;  // the instruction works on 64 bits

std::uint32_t width_of(Register reg) { return reg.is_wide ? kWide : 0; }

std::uint32_t operands(Register to, Register from) { return from.number << 5 | to.number; }
std::uint32_t operands(Register to, Register from, Register other) {
  return other.number << 16 | operands(to, from);
}

Condition inverse(Condition condition) {
  return static_cast<Condition>(static_cast<unsigned>(condition) ^ 1U);
}

// The field of a jump that holds the distance: its first bit in the word, and its width.
struct Field {
  unsigned low, width;
};

Field distance_field(std::uint32_t word) {
  if ((word & 0x7C000000) == 0x14000000) return {0, 26};  // b
  if ((word & 0x7E000000) == 0x36000000) return {5, 14};  // tbz, tbnz
  return {5, 19};                                         // b.cond, cbz, cbnz
}

}  // namespace

Encoder::Encoder(void* memory, std::size_t size)
    : words_(static_cast<std::uint32_t*>(memory)), capacity_(size / 4) {}

void Encoder::emit(std::uint32_t word) {
  if (count_ == capacity_) throw AssemblyError("the code memory is full");
  words_[count_++] = word;
}

void Encoder::bind(Label& label) {
  Target& bound = targets_[label];
  bound.place = static_cast<std::ptrdiff_t>(count_);
  for (const std::size_t at : bound.jumps) set_distance(at, bound.place - static_cast<std::ptrdiff_t>(at));
  bound.jumps.clear();
}

const void* Encoder::address_of(Label& label) { return words_ + targets_[label].place; }

bool Encoder::is_immediate(unsigned value) { return value < 0x1000 || (value & 0xFF000FFF) == 0; }

void Encoder::with_immediate(std::uint32_t opcode, Register to, Register from, unsigned value) {
  const std::uint32_t field = value < 0x1000 ? value : value >> 12 | 0x1000;
  emit(opcode | width_of(to) | field << 10 | operands(to, from));
}

void Encoder::add(Register to, Register from, unsigned value) { with_immediate(0x11000000, to, from, value); }
void Encoder::sub(Register to, Register from, unsigned value) { with_immediate(0x51000000, to, from, value); }
void Encoder::subs(Register to, Register from, unsigned value) {
  with_immediate(0x71000000, to, from, value);
}

void Encoder::shifted(std::uint32_t opcode, Register to, Register from, Register other, unsigned lsl,
                      unsigned lsr) {
  const std::uint32_t shift = lsr != 0 ? 1U << 22 | lsr << 10 : lsl << 10;
  emit(opcode | width_of(to) | shift | operands(to, from, other));
}

void Encoder::add(Register to, Register from, Register other, unsigned lsl) {
  shifted(0x0B000000, to, from, other, lsl);
}
void Encoder::add_lsr(Register to, Register from, Register other, unsigned lsr) {
  shifted(0x0B000000, to, from, other, 0, lsr);
}
void Encoder::sub(Register to, Register from, Register other, unsigned lsl) {
  shifted(0x4B000000, to, from, other, lsl);
}
void Encoder::sub_lsr(Register to, Register from, Register other, unsigned lsr) {
  shifted(0x4B000000, to, from, other, 0, lsr);
}
void Encoder::subs(Register to, Register from, Register other) { shifted(0x6B000000, to, from, other, 0); }
void Encoder::and_(Register to, Register from, Register other) { shifted(0x0A000000, to, from, other, 0); }
void Encoder::orr(Register to, Register from, Register other, unsigned lsl) {
  shifted(0x2A000000, to, from, other, lsl);
}
void Encoder::orr_lsr(Register to, Register from, Register other, unsigned lsr) {
  shifted(0x2A000000, to, from, other, 0, lsr);
}
void Encoder::eor(Register to, Register from, Register other) { shifted(0x4A000000, to, from, other, 0); }

// The mask is a run of ones, rotated right.
void Encoder::with_mask(std::uint32_t opcode, Register to, Register from, unsigned mask) {
  const auto low = static_cast<unsigned>(std::countr_zero(mask));
  const auto ones = static_cast<unsigned>(std::popcount(mask));
  const auto run = static_cast<std::uint32_t>((1ULL << ones) - 1);
  if (ones == 0 || ones == 32 || mask != run << low) throw AssemblyError("the mask is not a run of ones");
  emit(opcode | ((32 - low) & 31) << 16 | (ones - 1) << 10 | operands(to, from));
}

void Encoder::and_(Register to, Register from, unsigned mask) { with_mask(0x12000000, to, from, mask); }
void Encoder::orr(Register to, Register from, unsigned mask) { with_mask(0x32000000, to, from, mask); }
void Encoder::eor(Register to, Register from, unsigned mask) { with_mask(0x52000000, to, from, mask); }
void Encoder::tst(Register from, unsigned mask) { with_mask(0x72000000, wzr, from, mask); }

// MOVZ for the first 16 bits that are not zero, MOVK for the others.
void Encoder::mov(Register to, std::uint64_t value) {
  std::uint32_t opcode = 0x52800000;
  for (unsigned half = 0; half < 4; ++half) {
    const auto bits = static_cast<std::uint32_t>((value >> 16 * half) & 0xFFFF);
    const bool is_last = half == 3 || value >> 16 * (half + 1) == 0;
    if (bits != 0 || (is_last && opcode == 0x52800000)) {
      emit(opcode | width_of(to) | half << 21 | bits << 5 | to.number);
      opcode = 0x72800000;
    }
    if (is_last) return;
  }
}

void Encoder::madd(Register to, Register a, Register b, Register addend) {
  emit(0x1B000000 | width_of(to) | addend.number << 10 | operands(to, a, b));
}

void Encoder::ubfx(Register to, Register from, unsigned low, unsigned width) {
  emit(0x53000000 | low << 16 | (low + width - 1) << 10 | operands(to, from));
}

void Encoder::ubfiz(Register to, Register from, unsigned low, unsigned width) {
  emit(0x53000000 | ((32 - low) & 31) << 16 | (width - 1) << 10 | operands(to, from));
}

void Encoder::cset(Register to, Condition condition) { cinc(to, zero_like(to), condition); }

void Encoder::csel(Register to, Register if_so, Register if_not, Condition condition) {
  emit(0x1A800000 | width_of(to) | static_cast<std::uint32_t>(condition) << 12 | operands(to, if_so, if_not));
}

// CSINC adds 1 where the condition does not hold.
void Encoder::cinc(Register to, Register from, Condition condition) {
  emit(0x1A800400 | width_of(to) | static_cast<std::uint32_t>(inverse(condition)) << 12 |
       operands(to, from, from));
}

// size: of the access, as a power of two.
void Encoder::access(unsigned size, bool loads, Register reg, Register base, int offset) {
  const std::uint32_t word = size << 30 | (loads ? 1U << 22 : 0U) | operands(reg, base);
  const auto distance = static_cast<unsigned>(offset);
  if (offset >= 0 && (distance & ((1U << size) - 1)) == 0 && distance >> size < 0x1000)
    return emit(0x39000000 | word | distance >> size << 10);
  if (offset < -256 || offset > 255) throw AssemblyError("the offset is too large");
  emit(0x38000000 | word | (distance & 0x1FF) << 12);
}

void Encoder::ldrb(Register to, Register base, Register index) {
  emit(0x38604800 | operands(to, base, index));
}
void Encoder::ldr_lsl3(Register to, Register base, Register index) {
  emit(0xF8605800 | operands(to, base, index));
}
void Encoder::str_post(Register from, Register base, int step) {
  emit(0xB8000400 | (static_cast<unsigned>(step) & 0x1FF) << 12 | operands(from, base));
}

void Encoder::pair(std::uint32_t opcode, Register first, Register second, Register base, int offset) {
  emit(opcode | (static_cast<unsigned>(offset / 8) & 0x7F) << 15 | second.number << 10 |
       operands(first, base));
}

void Encoder::stp(Register first, Register second, Register base, int offset) {
  pair(0xA9000000, first, second, base, offset);
}
void Encoder::ldp(Register first, Register second, Register base, int offset) {
  pair(0xA9400000, first, second, base, offset);
}
void Encoder::stp_pre(Register first, Register second, Register base, int step) {
  pair(0xA9800000, first, second, base, step);
}
void Encoder::ldp_post(Register first, Register second, Register base, int step) {
  pair(0xA8C00000, first, second, base, step);
}

void Encoder::set_distance(std::size_t at, std::ptrdiff_t words) {
  const Field field = distance_field(words_[at]);
  const std::ptrdiff_t limit = std::ptrdiff_t{1} << (field.width - 1);
  if (words < -limit || words >= limit) throw AssemblyError("the jump is too far");
  words_[at] |= (static_cast<std::uint32_t>(words) & ((1U << field.width) - 1)) << field.low;
}

void Encoder::jump(std::uint32_t word, Label& label) {
  Target& to = targets_[label];
  emit(word);
  if (to.place < 0)
    to.jumps.push_back(count_ - 1);
  else
    set_distance(count_ - 1, to.place - static_cast<std::ptrdiff_t>(count_ - 1));
}

void Encoder::b(Label& label) { jump(0x14000000, label); }

void Encoder::b(const void* code) {
  const std::ptrdiff_t words = static_cast<const std::uint32_t*>(code) - (words_ + count_);
  emit(0x14000000);
  set_distance(count_ - 1, words);
}

void Encoder::bl(const void* code) {
  b(code);
  words_[count_ - 1] |= 0x80000000;
}

void Encoder::b(Condition condition, Label& label) {
  jump(0x54000000 | static_cast<std::uint32_t>(condition), label);
}
void Encoder::cbz(Register reg, Label& label) { jump(0x34000000 | width_of(reg) | reg.number, label); }
void Encoder::cbnz(Register reg, Label& label) { jump(0x35000000 | width_of(reg) | reg.number, label); }
void Encoder::tbz(Register reg, unsigned bit, Label& label) {
  jump(0x36000000 | bit << 19 | reg.number, label);
}
void Encoder::tbnz(Register reg, unsigned bit, Label& label) {
  jump(0x37000000 | bit << 19 | reg.number, label);
}
void Encoder::br(Register reg) { emit(0xD61F0000 | reg.number << 5); }
void Encoder::blr(Register reg) { emit(0xD63F0000 | reg.number << 5); }
void Encoder::ret() { emit(0xD65F03C0); }

}  // namespace racebeam::translator::aarch64
