#include "environment/reset/boot_analysis.hpp"

#include <algorithm>
#include <array>
#include <bitset>
#include <optional>

#include "emulator/base/opcodes.hpp"
#include "emulator/tia/registers/registers.hpp"

namespace racebeam {
namespace {

using opcode::Mode;
using opcode::Operation;

constexpr int kMaxSteps = 20000;
constexpr std::array<std::string_view, 8> kPlainSchemes = {"2K", "4K", "F8", "F8 swapped",
                                                           "F6", "F4", "E0", "MB"};
constexpr unsigned kFirstHotSpot = 0xFC0;  // the lowest of these schemes

struct Unknown {};  // thrown where the analysis ends

class BootAnalysis {
 public:
  explicit BootAnalysis(const Console& console) : console_(console), pc_(console.state().cpu.PC) {}

  BootFacts facts() {
    try {
      for (int n = 0; n < kMaxSteps && !all_known(); ++n) execute(kOpcodes[fetch()]);
    } catch (Unknown) {
    }
    return {ram_known_.all(), timer_known_, sound_known_.all()};
  }

 private:
  bool all_known() const { return ram_known_.all() && timer_known_ && sound_known_.all(); }

  static bool is_cartridge(unsigned address) { return (address & 0x1000) != 0; }
  static bool is_ram(unsigned address) { return (address & 0x1280) == 0x0080; }
  static bool is_tia(unsigned address) { return (address & 0x1080) == 0; }

  std::uint8_t read(unsigned address) const {
    if (is_cartridge(address) && (address & 0xFFF) < kFirstHotSpot)
      return console_.peek(static_cast<std::uint16_t>(address));
    if (!is_ram(address) || !ram_known_[address & 0x7F]) throw Unknown{};
    return ram_[address & 0x7F];
  }

  void write(unsigned address, std::uint8_t value) {
    if (is_cartridge(address)) {
      if ((address & 0xFFF) >= kFirstHotSpot) throw Unknown{};
    } else if (is_ram(address)) {
      ram_[address & 0x7F] = value;
      ram_known_.set(address & 0x7F);
    } else if (is_tia(address)) {
      const unsigned reg = address & 0x3F;
      if (is_sound(reg)) sound_known_.set(reg - AUDC0);
    } else if ((address & 0x14) == 0x14) {
      timer_known_ = true;
    }
  }

  std::uint8_t fetch() { return read(pc_++); }
  unsigned fetch_word() {
    const unsigned low = fetch();
    return low | static_cast<unsigned>(fetch()) << 8;
  }

  // Pointers in memory are not followed.
  unsigned address(Mode mode) {
    switch (mode) {
      case Mode::zero_page: return fetch();
      case Mode::zero_page_x: return (fetch() + x_) & 0xFFU;
      case Mode::zero_page_y: return (fetch() + y_) & 0xFFU;
      case Mode::absolute: return fetch_word();
      case Mode::absolute_x: return (fetch_word() + x_) & 0xFFFFU;
      case Mode::absolute_y: return (fetch_word() + y_) & 0xFFFFU;
      default: throw Unknown{};
    }
  }
  std::uint8_t operand(Mode mode) { return mode == Mode::immediate ? fetch() : read(address(mode)); }

  void set(std::uint8_t& to, std::uint8_t value) { result_ = to = value; }
  void change(unsigned address, int by) {
    result_ = static_cast<std::uint8_t>(read(address) + by);
    write(address, *result_);
  }
  void compare(std::uint8_t value, std::uint8_t with) {
    carry_ = value >= with;
    result_ = static_cast<std::uint8_t>(value - with);
  }

  template <typename T>
  static T known(const std::optional<T>& value) {
    if (!value) throw Unknown{};
    return *value;
  }
  void branch(bool taken) {
    const auto distance = static_cast<std::int8_t>(fetch());
    if (taken) pc_ = static_cast<std::uint16_t>(pc_ + distance);
  }
  bool zero() const { return known(result_) == 0; }
  bool negative() const { return (known(result_) & 0x80) != 0; }

  void push(std::uint8_t value) { write(0x100U + sp_--, value); }
  std::uint8_t pull() { return read(0x100U + ++sp_); }
  void call() {
    const unsigned target = fetch_word(), back = pc_ - 1U;
    push(static_cast<std::uint8_t>(back >> 8));
    push(static_cast<std::uint8_t>(back));
    pc_ = static_cast<std::uint16_t>(target);
  }
  void return_from_call() {
    const unsigned low = pull();
    pc_ = static_cast<std::uint16_t>((low | static_cast<unsigned>(pull()) << 8) + 1);
  }

  void execute(const Opcode& opcode);

  const Console& console_;
  std::uint16_t pc_;
  std::uint8_t a_ = 0, x_ = 0, y_ = 0, sp_ = 0xFF;  // as after a reset of the CPU
  std::optional<std::uint8_t> result_;              // for Z and N
  std::optional<bool> carry_;
  std::array<std::uint8_t, 128> ram_{};
  std::bitset<128> ram_known_;
  std::bitset<6> sound_known_;
  bool timer_known_ = false;
};

// clang-format off
void BootAnalysis::execute(const Opcode& opcode) {
  const Mode mode = opcode.mode;
  switch (opcode.operation) {
    case Operation::lda: return set(a_, operand(mode));
    case Operation::ldx: return set(x_, operand(mode));
    case Operation::ldy: return set(y_, operand(mode));
    case Operation::sta: return write(address(mode), a_);
    case Operation::stx: return write(address(mode), x_);
    case Operation::sty: return write(address(mode), y_);

    case Operation::tax: return set(x_, a_);
    case Operation::txa: return set(a_, x_);
    case Operation::tay: return set(y_, a_);
    case Operation::tya: return set(a_, y_);
    case Operation::tsx: return set(x_, sp_);
    case Operation::txs: sp_ = x_; return;

    case Operation::inx: return set(x_, static_cast<std::uint8_t>(x_ + 1));
    case Operation::dex: return set(x_, static_cast<std::uint8_t>(x_ - 1));
    case Operation::iny: return set(y_, static_cast<std::uint8_t>(y_ + 1));
    case Operation::dey: return set(y_, static_cast<std::uint8_t>(y_ - 1));
    case Operation::inc: return change(address(mode), 1);
    case Operation::dec: return change(address(mode), -1);

    case Operation::and_: return set(a_, a_ & operand(mode));
    case Operation::ora: return set(a_, a_ | operand(mode));
    case Operation::eor: return set(a_, a_ ^ operand(mode));
    case Operation::cmp: return compare(a_, operand(mode));
    case Operation::cpx: return compare(x_, operand(mode));
    case Operation::cpy: return compare(y_, operand(mode));

    case Operation::bne: return branch(!zero());
    case Operation::beq: return branch(zero());
    case Operation::bpl: return branch(!negative());
    case Operation::bmi: return branch(negative());
    case Operation::bcc: return branch(!known(carry_));
    case Operation::bcs: return branch(known(carry_));

    case Operation::pha: return push(a_);
    case Operation::pla: return set(a_, pull());
    case Operation::jmp: pc_ = static_cast<std::uint16_t>(address(mode)); return;
    case Operation::jsr: return call();
    case Operation::rts: return return_from_call();

    case Operation::clc: carry_ = false; return;
    case Operation::sec: carry_ = true; return;
    case Operation::sei: case Operation::cld: case Operation::clv: return;
    case Operation::nop: if (mode == Mode::implied) return; throw Unknown{};
    default: throw Unknown{};
  }
}
// clang-format on

}  // namespace

BootFacts analyze_boot(const Console& console, std::string_view scheme) {
  if (std::ranges::find(kPlainSchemes, scheme) == kPlainSchemes.end()) return {};
  return BootAnalysis(console).facts();
}

}  // namespace racebeam
