#include "tests/translator/random_program.hpp"

#include <algorithm>
#include <array>
#include <random>

#include "emulator/base/opcodes.hpp"
#include "tests/support/thumb_code.hpp"

namespace racebeam::test {
namespace {

struct Case {
  std::string_view scheme;
  std::size_t size;
};

constexpr Case kCases[] = {
    {"2K", 2048},    {"4K", 4096},    {"4K", 4096},     {"4K", 4096},   {"F8", 8192},     {"F8", 8192},
    {"F8SC", 8192},  {"F6", 16384},   {"F6SC", 16384},  {"F4", 32768},  {"F4SC", 32768},  {"FASC", 12288},
    {"E0", 8192},    {"E7", 16384},   {"FE", 8192},     {"DPC", 10240}, {"3F", 8192},     {"3E", 8192},
    {"UA", 8192},    {"CV", 2048},    {"CV 4K", 4096},  {"MB", 65536},  {"MC", 131072},   {"4KSC", 4096},
    {"FA2", 28672},  {"JANE", 16384}, {"FC", 16384},    {"3E+", 16384}, {"3EX", 8192},    {"UA clone", 8192},
    {"0FA0", 8192},  {"0840", 8192},  {"03E0", 8192},   {"EF", 65536},  {"SB", 131072},   {"UASW", 8192},
    {"EFSC", 65536}, {"DF", 131072},  {"DFSC", 131072}, {"BF", 262144}, {"BFSC", 262144}, {"X07", 65536},
    {"WD", 8192},    {"MDM", 32768}};

using Bytes = std::vector<std::uint8_t>;

// Idioms of games that random code seldom contains.
const std::vector<Bytes> kIdioms = {
    {0xAD, 0x84, 0x02, 0xD0, 0xFB},                                // LDA INTIM; BNE
    {0xAE, 0x84, 0x02, 0x10, 0xFB},                                // LDX INTIM; BPL
    {0x2C, 0x85, 0x02, 0x10, 0xFB},                                // BIT INSTAT; BPL
    {0xA9, 0x20, 0x8D, 0x96, 0x02},                                // TIM64T = $20
    {0xA9, 0x90, 0x8D, 0x95, 0x02},                                // TIM8T = $90
    {0xA9, 0x02, 0x85, 0x00, 0x85, 0x02, 0xA9, 0x00, 0x85, 0x00},  // VSYNC on, WSYNC, off
    {0xA9, 0x02, 0x85, 0x00, 0x85, 0x02, 0x85, 0x02, 0x85, 0x02, 0xA9, 0x00, 0x85, 0x00, 0x85, 0x01},
    {0xA2, 0x08, 0x85, 0x02, 0xCA, 0xD0, 0xFB},                          // LDX #8; WSYNC; DEX; BNE
    {0xA0, 0x14, 0x84, 0x02, 0x84, 0x09, 0x84, 0x1B, 0x88, 0x10, 0xF7},  // a picture of 21 lines
    {0xA2, 0xFF, 0x9A, 0xD8},                                            // LDX #$FF; TXS; CLD
    {0xA2, 0x1F, 0x9A, 0x68, 0x68, 0x48, 0x48},  // the stack in the TIA: pulls and pushes
    {0xF8},
    {0xF8, 0x69, 0x37, 0xE9, 0x19},
    {0xD8},                                                              // decimal arithmetic
    {0xA9, 0xA5, 0x85, 0x90, 0xA9, 0x60, 0x85, 0x92, 0x20, 0x90, 0x00},  // a subroutine written into RAM
    {0xA9, 0xE6, 0x85, 0xA0, 0xA9, 0xB0, 0x85, 0xA1, 0xA9, 0x4C, 0x85, 0xA2, 0x4C, 0xA0, 0x00},
};

// And of those that an ARM helps: fast fetch on and off, reads of fetchers through it, and calls.
const std::vector<Bytes> kDpcPlusIdioms = {
    {0xA9, 0x00, 0x8D, 0x58, 0x10},                                // STA $1058: fast fetch on
    {0xA9, 0x08, 0x85, 0x0D, 0xA9, 0x11, 0x85, 0x0E},              // two fetchers
    {0xA9, 0x01, 0x8D, 0x58, 0x10, 0xA9, 0x08, 0x85, 0x0D},        // off
    {0xA2, 0xFF, 0x8E, 0x5A, 0x10, 0xEA},                          // STX $105A: call the ARM
    {0xA2, 0x01, 0x8E, 0x5A, 0x10, 0xAD, 0x08, 0x10, 0x85, 0x1B},  // copy, and read what was copied
    {0xA2, 0x00, 0x8E, 0x58, 0x10, 0xA0, 0x10, 0xA9, 0x08, 0x85, 0x1B, 0x88, 0xD0, 0xF9, 0xCA, 0x8E, 0x58,
     0x10},  // a loop of 16 reads through fast fetch
};

// The same with streams, and jumps through two of them.
const std::vector<Bytes> kCdfIdioms = {
    {0xA9, 0x00, 0x8D, 0xF2, 0x1F},                                            // STA $1FF2: fast fetch on
    {0xA9, 0x05, 0x85, 0x0D, 0xA9, 0x06, 0x85, 0x0E},                          // two streams
    {0xA9, 0x23, 0x85, 0x19},                                                  // the amplitude
    {0xA9, 0x0F, 0x8D, 0xF2, 0x1F, 0xA9, 0x05, 0x85, 0x0D},                    // off
    {0xA9, 0xF0, 0x8D, 0xF2, 0x1F},                                            // on, with waves
    {0xA2, 0xFF, 0x8E, 0xF3, 0x1F, 0xEA},                                      // STX $1FF3: call the ARM
    {0xA2, 0x01, 0x8E, 0xF1, 0x1F, 0x8E, 0xF1, 0x1F, 0x8E, 0xF0, 0x1F},        // write to the display data
    {0xA2, 0x10, 0x8E, 0xF1, 0x1F, 0x8E, 0xF1, 0x1F, 0xA9, 0x20, 0x85, 0x1B},  // and read there
    {0x4C, 0x00, 0x00},
    {0x4C, 0x01, 0x00},
    {0xA2, 0x00, 0x8E, 0xF2, 0x1F, 0xA0, 0x10, 0xA9, 0x07, 0x85, 0x1B, 0x88, 0xD0, 0xF9, 0xCA, 0x8E, 0xF2,
     0x1F},  // a loop of 16 reads through fast fetch
};

struct ArmCase {
  Case image;
  const std::vector<Bytes>& idioms;
  std::size_t entry;         // of the ARM's code in the image
  std::uint8_t display;      // upper byte of the display data's offset in RAM
  bool has_streams = false;  // whose increments and pointers the driver has
};
const ArmCase kArmCases[] = {{{"DPC+", 32768}, kDpcPlusIdioms, 3072 + 8, 0x0C},
                             {{"CDFJ", 32768}, kCdfIdioms, 2048 + 8, 0x08, true},
                             {{"CDFJ+", 32768}, kCdfIdioms, 0x7800, 0x08, true}};

class Writer {
 public:
  explicit Writer(std::uint32_t seed)
      : random_(seed), case_(kCases[pick(std::size(kCases))]), rom_(case_.size) {}

  Writer(std::uint32_t seed, const ArmCase& of)
      : random_(seed), case_(of.image), arm_(&of), rom_(case_.size) {}

  Program write() {
    const bool noise = chance(4);
    std::size_t at = 0;
    while (at < rom_.size()) {
      if (noise)
        rom_[at++] = opcode();
      else
        at = instruction(at);
    }
    if (!noise) scatter(kIdioms, pick(60));
    if (arm_ != nullptr) add_arm_code();
    vectors();
    return {case_.scheme, std::move(rom_)};
  }

 private:
  unsigned pick(std::size_t limit) { return static_cast<unsigned>(random_() % limit); }
  bool chance(unsigned percent) { return pick(100) < percent; }
  std::uint8_t byte() { return static_cast<std::uint8_t>(random_()); }

  void scatter(const std::vector<Bytes>& idioms, unsigned times) {
    for (unsigned i = times; i > 0; --i) put(pick(rom_.size()), idioms[pick(idioms.size())]);
  }

  // Most programs have code for the ARM that adds up the display data, and returns. In some, it never ends.
  void add_arm_code() {
    using namespace thumb;
    scatter(arm_->idioms, 40 + pick(200));
    if (arm_->has_streams) add_streams();
    if (chance(10)) return;
    if (chance(5)) return thumb::put(rom_, arm_->entry, {kForEver});
    thumb::put(rom_, arm_->entry,
               {mov_number(1, 1), lsl(1, 1, 30), mov_number(2, arm_->display), lsl(2, 2, 8), add(1, 1, 2),
                mov_number(2, byte()), ldrb(3, 1, 0), add(4, 4, 3), add_number(1, 1), sub_number(2, 1),
                branch_if(kNe, -8), strb(4, 1, 0), bx(kLr)});
  }

  // Pointers to the display data, steps of up to three bytes, and where the code of CDFJ+ begins.
  void add_streams() {
    constexpr std::size_t kPointers = 0x98, kIncrements = 0x124, kStreams = 35, kStackAndEntry = 0x17F4;
    for (std::size_t i = 0; i < kStreams; ++i) {
      put(kPointers + 4 * i, {byte(), byte(), byte(), static_cast<std::uint8_t>(pick(0x18))});
      put(kIncrements + 4 * i, {byte(), static_cast<std::uint8_t>(pick(3)), 0, 0});
    }
    if (arm_->entry == 0x7800) put(kStackAndEntry, {0xDC, 0x1F, 0, 0x40, 0x01, 0x78, 0, 0});
  }

  // Seldom an opcode that halts the CPU.
  std::uint8_t opcode() {
    const std::uint8_t code = byte();
    return (code & 0x1F) == 0x12 && !chance(2) ? 0xEA : code;
  }

  void put(std::size_t at, const Bytes& bytes) {
    for (std::size_t i = 0; i < bytes.size() && at + i < rom_.size(); ++i) rom_[at + i] = bytes[i];
  }

  std::size_t instruction(std::size_t at) {
    static constexpr std::array<std::uint8_t, 24> kFrequent = {
        0xA9, 0xA2, 0xA0, 0xA5, 0xB5, 0xBD, 0xB9, 0xB1, 0x85, 0x86, 0x84, 0x95,
        0x99, 0x9D, 0x91, 0x8D, 0x69, 0xC9, 0xE6, 0xC6, 0xCA, 0x88, 0x20, 0x60};
    const std::uint8_t code = chance(40) ? kFrequent[pick(kFrequent.size())] : opcode();
    const bool jsr = code == 0x20, branch = (code & 0x1F) == 0x10;
    switch (jsr ? 3 : kOpcodes[code].length) {
      case 1: put(at, {code}); return at + 1;
      case 2: put(at, {code, branch ? distance() : near_operand()}); return at + 2;
      default: {
        const unsigned address = jsr || code == 0x4C ? target() : far_operand();
        put(at, {code, static_cast<std::uint8_t>(address), static_cast<std::uint8_t>(address >> 8)});
        return at + 3;
      }
    }
  }

  std::uint8_t distance() {
    if (chance(10)) return byte();
    return static_cast<std::uint8_t>(chance(75) ? pick(24) : 256 - 2 - pick(24));
  }

  std::uint8_t near_operand() {
    if (chance(35)) return static_cast<std::uint8_t>(0x80 | pick(128));
    return static_cast<std::uint8_t>(chance(80) ? pick(0x40) : pick(256));
  }

  unsigned mirror(unsigned address) { return address | pick(8) << 13; }

  unsigned target() {
    if (chance(3)) return 0x80 | pick(128);
    return mirror(0x1000 | (chance(60) ? 0x40 : 0) | pick(0x1000));
  }

  unsigned far_operand() {
    const unsigned kind = pick(100);
    if (kind < 30) return mirror(0x1000 | pick(0x1000));
    if (kind < 38) return mirror(0x1FE0 | pick(0x20));                                  // hot spots
    if (kind < 45) return mirror(0x1000 | pick(0x80));                                  // and ports
    if (kind < 65) return mirror(0x0280 | pick(0x20));                                  // RIOT
    if (kind < 75) return mirror(0x0180 | pick(0x80));                                  // RAM, the stack
    if (kind < 90) return mirror((chance(50) ? 0 : 0x40 | pick(2) << 8) | pick(0x40));  // TIA
    return pick(0x10000);
  }

  // Each slice that can be at the end of the address space gets its own vectors.
  void vectors() {
    for (std::size_t end = 1024; end <= rom_.size(); end += 1024)
      for (std::size_t at = end - 6; at < end; at += 2) {
        const unsigned address = mirror(0x1000 | pick(0x1000));
        put(at, {static_cast<std::uint8_t>(address), static_cast<std::uint8_t>(address >> 8)});
      }
  }

  std::mt19937 random_;
  const Case& case_;
  const ArmCase* arm_ = nullptr;
  Bytes rom_;
};

}  // namespace

Program make_program(std::uint32_t seed) { return Writer(seed).write(); }

Program make_arm_program(std::uint32_t seed) {
  return Writer(seed, kArmCases[seed % std::size(kArmCases)]).write();
}

}  // namespace racebeam::test
