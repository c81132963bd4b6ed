#include "environment/reset/boot_analysis.hpp"

#include <algorithm>
#include <array>
#include <bitset>
#include <optional>

#include "emulator/tia/registers/registers.hpp"

namespace racebeam {
namespace {

constexpr int kMostInstructions = 20000;
constexpr std::array<std::string_view, 8> kPlainSchemes = {"2K", "4K", "F8", "F8 swapped",
                                                           "F6", "F4", "E0", "MB"};
constexpr unsigned kFirstHotSpot = 0xFC0;  // the lowest of these schemes

struct Unknown {};  // thrown where the analysis ends

class BootAnalysis {
 public:
  explicit BootAnalysis(const Console& console) : console_(console), pc_(console.state().cpu.PC) {}

  BootFacts facts() {
    try {
      for (int n = 0; n < kMostInstructions && !all_known(); ++n) execute(fetch());
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
  unsigned zero_page(std::uint8_t index = 0) { return (fetch() + index) & 0xFF; }
  unsigned absolute(std::uint8_t index = 0) { return (fetch_word() + index) & 0xFFFF; }

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

  void execute(std::uint8_t opcode);

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
void BootAnalysis::execute(std::uint8_t opcode) {
  switch (opcode) {
    case 0x78: case 0xD8: case 0xB8: case 0xEA: return;  // SEI CLD CLV NOP
    case 0x18: carry_ = false; return;                   // CLC
    case 0x38: carry_ = true; return;                    // SEC
    case 0xA9: return set(a_, fetch());                  // LDA LDX LDY #
    case 0xA2: return set(x_, fetch());
    case 0xA0: return set(y_, fetch());
    case 0xA5: return set(a_, read(zero_page()));        // LDA LDX LDY zp, zp,X
    case 0xA6: return set(x_, read(zero_page()));
    case 0xA4: return set(y_, read(zero_page()));
    case 0xB5: return set(a_, read(zero_page(x_)));
    case 0xAD: return set(a_, read(absolute()));         // LDA abs, abs,X, abs,Y
    case 0xBD: return set(a_, read(absolute(x_)));
    case 0xB9: return set(a_, read(absolute(y_)));
    case 0xAE: return set(x_, read(absolute()));         // LDX LDY abs
    case 0xAC: return set(y_, read(absolute()));
    case 0x85: return write(zero_page(), a_);            // STA STX STY zp, zp,X
    case 0x86: return write(zero_page(), x_);
    case 0x84: return write(zero_page(), y_);
    case 0x95: return write(zero_page(x_), a_);
    case 0x94: return write(zero_page(x_), y_);
    case 0x8D: return write(absolute(), a_);             // STA STX STY abs, abs,X, abs,Y
    case 0x8E: return write(absolute(), x_);
    case 0x8C: return write(absolute(), y_);
    case 0x9D: return write(absolute(x_), a_);
    case 0x99: return write(absolute(y_), a_);
    case 0xAA: return set(x_, a_);                       // TAX TXA TAY TYA TSX TXS
    case 0x8A: return set(a_, x_);
    case 0xA8: return set(y_, a_);
    case 0x98: return set(a_, y_);
    case 0xBA: return set(x_, sp_);
    case 0x9A: sp_ = x_; return;
    case 0xE8: return set(x_, static_cast<std::uint8_t>(x_ + 1));  // INX DEX INY DEY
    case 0xCA: return set(x_, static_cast<std::uint8_t>(x_ - 1));
    case 0xC8: return set(y_, static_cast<std::uint8_t>(y_ + 1));
    case 0x88: return set(y_, static_cast<std::uint8_t>(y_ - 1));
    case 0xE6: return change(zero_page(), 1);            // INC DEC zp
    case 0xC6: return change(zero_page(), -1);
    case 0x29: return set(a_, a_ & fetch());             // AND ORA EOR #
    case 0x09: return set(a_, a_ | fetch());
    case 0x49: return set(a_, a_ ^ fetch());
    case 0xC9: return compare(a_, fetch());              // CMP CPX CPY #
    case 0xE0: return compare(x_, fetch());
    case 0xC0: return compare(y_, fetch());
    case 0xD0: return branch(!zero());                   // BNE BEQ BPL BMI BCC BCS
    case 0xF0: return branch(zero());
    case 0x10: return branch(!negative());
    case 0x30: return branch(negative());
    case 0x90: return branch(!known(carry_));
    case 0xB0: return branch(known(carry_));
    case 0x48: return push(a_);                          // PHA PLA
    case 0x68: return set(a_, pull());
    case 0x4C: pc_ = static_cast<std::uint16_t>(fetch_word()); return;  // JMP JSR RTS
    case 0x20: return call();
    case 0x60: return return_from_call();
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
