#include "environment/reset/boot_analysis.hpp"

#include <algorithm>
#include <array>
#include <bitset>

#include "emulator/cpu/known_cpu.hpp"
#include "emulator/tia/registers/registers.hpp"

namespace racebeam {
namespace {

constexpr int kMaxSteps = 20000;
constexpr std::array<std::string_view, 8> kPlainSchemes = {"2K", "4K", "F8", "F8 swapped",
                                                           "F6", "F4", "E0", "MB"};
constexpr unsigned kFirstHotSpot = 0xFC0;  // the lowest of these schemes

// What the program has written so far.
class BootAnalysis : KnownBus {
 public:
  explicit BootAnalysis(const Console& console) : console_(console), cpu_(*this, console.state().cpu.PC) {}

  BootFacts facts() {
    try {
      for (int n = 0; n < kMaxSteps && !all_known(); ++n) cpu_.step();
    } catch (Unknown) {
    }
    return {ram_known_.all(), timer_known_, sound_known_.all()};
  }

 private:
  bool all_known() const { return ram_known_.all() && timer_known_ && sound_known_.all(); }

  static bool is_cartridge(unsigned address) { return (address & 0x1000) != 0; }
  static bool is_ram(unsigned address) { return (address & 0x1280) == 0x0080; }
  static bool is_tia(unsigned address) { return (address & 0x1080) == 0; }

  std::uint8_t read(unsigned address) override {
    if (is_cartridge(address) && (address & 0xFFF) < kFirstHotSpot)
      return console_.peek(static_cast<std::uint16_t>(address));
    if (!is_ram(address) || !ram_known_[address & 0x7F]) throw Unknown{};
    return ram_[address & 0x7F];
  }

  void write(unsigned address, std::uint8_t value) override {
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

  const Console& console_;
  KnownCpu cpu_;
  std::array<std::uint8_t, 128> ram_{};
  std::bitset<128> ram_known_;
  std::bitset<6> sound_known_;
  bool timer_known_ = false;
};

}  // namespace

BootFacts analyze_boot(const Console& console, std::string_view scheme) {
  if (std::ranges::find(kPlainSchemes, scheme) == kPlainSchemes.end()) return {};
  return BootAnalysis(console).facts();
}

}  // namespace racebeam
