#include "tests/translator/hostile.hpp"

#include <array>
#include <initializer_list>
#include <random>
#include <string_view>

namespace racebeam::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr unsigned kBankSize = 4096;
constexpr unsigned kStart = 0xF000;

// A bank of 4K, filled from its beginning.
class Bank {
 public:
  explicit Bank(std::uint8_t filler = 0xEA) : bytes_(kBankSize, filler) { vectors(kStart); }

  unsigned pc() const { return kStart + at_; }
  unsigned room_left() const { return kCodeEnd - at_; }

  Bank& put(std::initializer_list<unsigned> bytes) {
    for (const unsigned byte : bytes) bytes_[at_++] = static_cast<std::uint8_t>(byte);
    return *this;
  }

  // Repeats `bytes`, as long as there is room for a jump after them.
  Bank& fill(const Bytes& bytes, unsigned most = kBankSize) {
    for (; most > 0 && room_left() > bytes.size() + 3; --most)
      for (const std::uint8_t byte : bytes) bytes_[at_++] = byte;
    return *this;
  }

  Bank& jump(unsigned target) { return put({0x4C, target & 0xFF, target >> 8}); }
  Bank& call(unsigned target) { return put({0x20, target & 0xFF, target >> 8}); }
  Bank& new_frame() { return put({0xA9, 2, 0x85, 0, 0x85, 2, 0x85, 2, 0xA9, 0, 0x85, 0}); }
  Bank& stack() { return put({0xA2, 0xFF, 0x9A}); }
  Bank& skip_to(unsigned offset) { return at_ = offset, *this; }

  // The vectors of BRK, reset and NMI.
  Bank& vectors(unsigned target) {
    for (unsigned at = kBankSize - 6; at < kBankSize; at += 2) {
      bytes_[at] = static_cast<std::uint8_t>(target);
      bytes_[at + 1] = static_cast<std::uint8_t>(target >> 8);
    }
    return *this;
  }

  std::uint8_t& operator[](unsigned offset) { return bytes_[offset]; }
  const Bytes& bytes() const { return bytes_; }

  static constexpr unsigned kCodeEnd = 0xFC0;  // hot spots come after it

 private:
  Bytes bytes_;
  unsigned at_ = 0;
};

Bytes repeated(const Bytes& bytes, unsigned times) {
  Bytes all;
  for (; times > 0; --times) all.insert(all.end(), bytes.begin(), bytes.end());
  return all;
}

class Collection {
 public:
  std::vector<HostileProgram> all;

  void add(std::string name, std::string_view scheme, Bytes rom) {
    all.push_back({std::move(name), {scheme, std::move(rom)}});
  }
  void add(std::string name, const Bank& bank) { add(std::move(name), "4K", bank.bytes()); }

  // Banks with the same code.
  void add_banks(std::string name, std::string_view scheme, unsigned banks, const Bank& bank) {
    add(std::move(name), scheme, repeated(bank.bytes(), banks));
  }

  // `body` fills a bank, with frames that end, and with a frame that never does.
  void storm(const std::string& name, const Bytes& body) {
    add(name, Bank().stack().fill(body).jump(kStart));
    add(name + ", in frames", Bank().stack().new_frame().fill(body, 900).jump(kStart));
  }
};

// Thousands of instructions that translated code leaves to the interpreter.
void add_storms(Collection& to) {
  struct Storm {
    const char* name;
    Bytes body;
  };
  const std::vector<Storm> storms = {
      {"INC GRP0", {0xE6, 0x1B}},
      {"DEC COLUBK", {0xC6, 0x09}},
      {"ASL WSYNC", {0x06, 0x02}},
      {"ROR AUDV0", {0x66, 0x19}},
      {"LSR of no register", {0x46, 0x3F}},
      {"ROL RESP0", {0x26, 0x10}},
      {"INC TIM64T", {0xEE, 0x96, 0x02}},
      {"DEC SWACNT", {0xCE, 0x81, 0x02}},
      {"ASL of the cartridge", {0x0E, 0x00, 0xF8}},
      {"INC GRP0,X", {0xF6, 0x1C}},
      {"INC absolute,X of a device", {0xFE, 0x09, 0x00}},
      {"SLO zero page", {0x07, 0x80}},
      {"LAX absolute,Y", {0xBF, 0x00, 0xF8}},
      {"DCP of a device", {0xC7, 0x1B}},
      {"NOP zero page", {0x04, 0x80}},
      {"undocumented NOP", {0x1A}},
      {"PHP PLP", {0x08, 0x28}},
      {"LDA ($1B),Y", {0xB1, 0x1B}},
      {"STA ($FF),Y", {0x91, 0xFF}},
      {"LDA (zp,X) from the TIA", {0xA1, 0x10}},
      {"LDA (zp),Y from a device", {0xA9, 0x02, 0x85, 0x81, 0xB1, 0x80}},
      {"PHA with the stack in the TIA", {0xA2, 0x1B, 0x9A, 0x48}},
      {"PLA with the stack in the TIA", {0xA2, 0x01, 0x9A, 0x68}},
      {"JSR with the stack in the TIA", {0xA2, 0x1B, 0x9A, 0x20, 0x00, 0xF0}},
      {"RTS with the stack in the TIA", {0xA2, 0x1B, 0x9A, 0x60}},
      {"WSYNC", {0x85, 0x02}},
      {"WSYNC and INC GRP0", {0x85, 0x02, 0xE6, 0x1B}},
      {"WSYNC by INC", {0xE6, 0x02, 0xEA}},
      {"LDA INTIM", {0xAD, 0x84, 0x02}},
      {"collisions", {0xA5, 0x02, 0x85, 0x1B, 0x85, 0x2A}},
      {"paddles", {0xA5, 0x08, 0xA5, 0x0C}},
      {"decimal", {0xF8, 0x69, 0x99, 0xE9, 0x11}},
      {"new GRP0 and GRP1", {0xE8, 0x86, 0x1B, 0x86, 0x1C}},
      {"new PF0 to PF2", {0xE8, 0x86, 0x0D, 0x86, 0x0E, 0x86, 0x0F}},
      {"RESP0 to RESBL", {0x85, 0x10, 0x85, 0x11, 0x85, 0x12, 0x85, 0x13, 0x85, 0x14}},
      {"HMOVE and HMCLR", {0x85, 0x2A, 0x85, 0x2B}},
      {"NUSIZ0 and NUSIZ1", {0xE8, 0x86, 0x04, 0x86, 0x05}},
      {"timer loops", {0xA9, 0x02, 0x8D, 0x96, 0x02, 0xAD, 0x84, 0x02, 0xD0, 0xFB}},
      {"NOP", {0xEA}},
  };
  for (const Storm& storm : storms) to.storm("storm of " + std::string(storm.name), storm.body);
}

// Documented instructions between two that are left to the interpreter.
void add_mixtures(Collection& to) {
  for (const unsigned between : {1U, 2U, 4U, 6U, 8U, 12U, 16U, 24U, 32U, 48U}) {
    Bytes body = repeated({0xE6, 0x80}, between);
    body.insert(body.end(), {0x07, 0x1B});
    to.storm("SLO after " + std::to_string(between) + " INC", body);
  }
  for (const unsigned between : {4U, 12U}) {
    Bytes body = repeated({0xA5, 0x0C}, between);
    body.insert(body.end(), {0xE6, 0x1B});
    to.storm("INC GRP0 after " + std::to_string(between) + " reads of the TIA", body);
  }
}

// JMP through a pointer in RAM that steps through all addresses, into `field`. step: odd, added each time.
void add_field(Collection& to, const std::string& name, const Bytes& field, unsigned step) {
  Bank bank;
  bank.put(
      {0xA5, 0x80, 0x18, 0x69, step & 0xFF, 0x85, 0x80, 0xA5, 0x81, 0x69, step >> 8, 0x09, 0xF0, 0x85, 0x81});
  bank.put({0xC9, 0xF1, 0x90, 0xEF, 0xC9, 0xFF, 0xB0, 0xEB});  // $F100 to $FEFF only
  bank.put({0x6C, 0x80, 0x00});
  bank.skip_to(0x100).fill(field);
  for (unsigned at = 0xF00; at < 0xFF0; at += 3) bank.skip_to(at).jump(kStart);
  bank.vectors(kStart);
  to.add(name, bank);
}

void add_fields(Collection& to) {
  struct Field {
    const char* name;
    Bytes field;
  };
  const std::vector<Field> fields = {
      {"NOP", {0xEA}},
      {"NOP and jumps back", {0xEA, 0xEA, 0xEA, 0xEA, 0x4C, 0x00, 0xF0}},
      {"LDA in two alignments", {0xA9}},
      {"LDA in three alignments", {0xAD}},
      {"branches everywhere", {0xD0, 0x10, 0xF0, 0x10, 0x4C, 0x00, 0xF0}},
      {"calls that never return", {0x20, 0x00, 0xF0}},
      {"STA GRP0", {0x85, 0x1B}},
      {"ADC", {0x69, 0x69, 0x69, 0x69, 0x69, 0x69, 0x4C, 0x00, 0xF0}},
      {"LDA (zp),Y", {0xB1, 0xB1, 0xB1, 0xB1, 0x91, 0x91, 0x4C, 0x00, 0xF0}},
  };
  for (const Field& field : fields)
    for (const unsigned step : {1U, 0x35U, 0x4ABU})
      add_field(to, "every address, " + std::string(field.name) + ", by " + std::to_string(step), field.field,
                step);
}

// Random documented instructions, entered everywhere.
void add_random_fields(Collection& to) {
  static constexpr std::array<std::uint8_t, 16> kOpcodes = {0xA9, 0xA5, 0xB5, 0xBD, 0x85, 0x95, 0xE6, 0x65,
                                                            0xE5, 0x10, 0xD0, 0x90, 0x4A, 0x48, 0x24, 0xC9};
  for (unsigned seed = 1; seed <= 4; ++seed) {
    std::mt19937 random(seed);
    Bytes field(0xC00);
    for (std::uint8_t& byte : field) {
      byte = random() % 3 == 0 ? static_cast<std::uint8_t>(random()) : kOpcodes[random() % kOpcodes.size()];
      if ((byte & 0x1F) == 0x12 || (byte & 0x9F) == 0x02) byte = 0xEA;  // it would halt the CPU
    }
    add_field(to, "every address, random code " + std::to_string(seed), field, 0x2F5);
  }
}

// Switches to the next bank after a few instructions.
void add_bank_storms(Collection& to) {
  struct Scheme {
    const char* name;
    unsigned banks;
    unsigned hot_spot, count;  // the first, and how many
  };
  static constexpr Scheme kSchemes[] = {{"F8", 2, 0x1FF8, 2},  {"F6", 4, 0x1FF6, 4},   {"F4", 8, 0x1FF4, 8},
                                        {"E0", 2, 0x1FE0, 24}, {"FASC", 3, 0x1FF8, 3}, {"UA", 2, 0x0220, 1}};
  for (const Scheme& scheme : kSchemes)
    for (const unsigned between : {0U, 4U, 16U}) {
      Bank bank;
      bank.skip_to(0x200).vectors(kStart + 0x200);
      for (unsigned turn = 0; bank.room_left() > 3 + between + 3; ++turn) {
        const unsigned address = scheme.hot_spot + turn % scheme.count;
        bank.put({0xAD, address & 0xFF, address >> 8}).fill({0xE8}, between);
      }
      bank.jump(kStart + 0x200);
      to.add_banks(std::string(scheme.name) + " switched after " + std::to_string(between) + " INX",
                   scheme.name, scheme.banks, bank);
    }
  for (const unsigned between : {0U, 8U}) {
    Bank bank;
    bank.skip_to(0x200).vectors(kStart + 0x200);
    while (bank.room_left() > 6 + between + 3) bank.put({0xE8, 0x86, 0x3F}).fill({0xEA}, between);
    bank.jump(kStart + 0x200);
    to.add_banks("3F switched after " + std::to_string(between) + " NOP", "3F", 4, bank);
  }
  for (const unsigned between : {0U, 8U, 64U}) {
    Bank bank;
    bank.skip_to(0x200).vectors(kStart + 0x200);
    while (bank.room_left() > 3 + between + 3) bank.put({0xAD, 0xF0, 0x1F}).fill({0xE8}, between);
    bank.jump(kStart + 0x200);
    to.add_banks("64K, the next bank after " + std::to_string(between) + " INX", "MB", 16, bank);
  }
}

// All 16 banks of 64K have different code, each seen in all eight mirrors, so that the code memory becomes
// full.
void add_full_memory(Collection& to) {
  static constexpr std::array<std::uint8_t, 8> kOpcodes = {0xA5, 0x65, 0xE5, 0x85, 0x95, 0xB5, 0x45, 0xC5};
  for (unsigned seed = 1; seed <= 3; ++seed) {
    std::mt19937 random(seed);
    Bytes rom;
    for (unsigned number = 0; number < 16; ++number) {
      Bank bank;
      bank.skip_to(0x100).vectors(kStart + 0x100);
      while (bank.room_left() > 40) {
        if (seed > 1 && random() % 8 == 0)
          bank.put({0xD0, 2 * static_cast<unsigned>(random() % 10)});
        else
          bank.put({kOpcodes[random() % kOpcodes.size()], 0x80U | static_cast<unsigned>(random() % 0x60)});
      }
      const unsigned mirror = (number * 5 + seed) % 8 << 13;
      bank.put({0xAD, 0xF0, 0x1F}).jump(mirror | 0x1100);
      rom.insert(rom.end(), bank.bytes().begin(), bank.bytes().end());
    }
    to.add("64K of code in all mirrors " + std::to_string(seed), "MB", std::move(rom));
  }
  Bank mirrors;
  for (unsigned turn = 0; mirrors.room_left() > 16; ++turn)
    mirrors.put({0xE6, 0x80, 0xE6, 0x81}).jump(((turn * 3 % 8) << 13 | 0x1000) + (mirrors.pc() + 3 - kStart));
  to.add("mirrors by turns", mirrors.jump(kStart));
}

// Code in RAM, and from there into the cartridge and back.
void add_code_in_ram(Collection& to) {
  for (const unsigned between : {0U, 3U, 10U, 40U}) {
    Bank bank;
    bank.stack().put({0xA9, 0xE6, 0x85, 0x90, 0xA9, 0xA0, 0x85, 0x91, 0xA9, 0x60, 0x85, 0x92});
    const unsigned again = bank.pc();
    to.add("RAM and back with " + std::to_string(between) + " INX",
           bank.call(0x0090).fill({0xE8}, between).jump(again));
  }
  to.add("a loop in RAM", Bank()
                              .put({0xA9, 0xE6, 0x85, 0x90, 0xA9, 0xA0, 0x85, 0x91, 0xA9, 0x4C,
                                    0x85, 0x92, 0xA9, 0x90, 0x85, 0x93, 0xA9, 0x00, 0x85, 0x94})
                              .jump(0x0090));
  to.add("code in the TIA", Bank().jump(0x0030));
  to.add("code in the RIOT", Bank().jump(0x0284));
}

void add_interrupts(Collection& to) {
  to.add("BRK and RTI", Bank()
                            .put({0x00, 0xEA})
                            .skip_to(0)
                            .fill({0x00, 0xEA}, 900)
                            .jump(kStart)
                            .skip_to(0xF80)
                            .put({0x40})
                            .vectors(kStart + 0xF80));
  to.add("BRK to itself", Bank(0x00));
  to.add("BRK through a field", Bank().put({0xE6, 0x80, 0x00}).vectors(kStart));
  to.add("RTI from a table", Bank()
                                 .put({0xA9, 0xF0, 0x48, 0xE6, 0x80, 0xA5, 0x80, 0x48, 0x08, 0x40})
                                 .skip_to(0x0A)
                                 .fill({0x4C, 0x00, 0xF0}, 100));
  to.add("JMP through the cartridge", Bank()
                                          .fill({0x6C, 0x00, 0xF8}, 300)
                                          .skip_to(0x800)
                                          .put({0x03, 0xF0})
                                          .skip_to(0x003)
                                          .put({0x6C, 0x02, 0xF8})
                                          .skip_to(0x802)
                                          .put({0x00, 0xF0}));
  to.add("nothing but RTS", [] {
    Bank bank(0x60);
    return bank.stack()
        .put({0xA9, 0xF2, 0x48, 0xE6, 0x80, 0xA5, 0x80, 0x48, 0x60, 0x4C, 0x03, 0xF0})
        .vectors(kStart);
  }());
}

// Steps that are run twice, or are very short.
void add_frames(Collection& to) {
  to.add("no frame ever ends", Bank().jump(kStart));
  to.add("frames of two lines", Bank().new_frame().jump(kStart));
  to.add("frames of one line", Bank().put({0xA9, 2, 0x85, 0, 0xA9, 0, 0x85, 2, 0x85, 0}).jump(kStart));
  // X times Y iterations of a loop, then VSYNC: a frame with a few more or less instructions than a step may
  // have.
  for (const unsigned turns : {10U, 14U, 20U, 32U, 33U, 40U, 66U, 100U})
    to.add("overlong, " + std::to_string(turns) + " times 256 turns",
           Bank()
               .new_frame()
               .put({0xA0, turns, 0xA2, 0, 0xCA, 0xEA, 0xD0, 0xFC, 0x88, 0xD0, 0xF7})
               .jump(kStart));
  // The frame ends in the middle of a line with objects. Pixels that are drawn ahead are visible, so the step
  // is run again.
  for (const unsigned lines : {20U, 100U, 200U})
    for (const unsigned wait : {12U, 25U})
      to.add("ends in line " + std::to_string(lines) + " after " + std::to_string(wait) + " NOP",
             Bank()
                 .put({0xA9, 0xFF, 0x85, 0x0D, 0x85,  0x0E, 0x85, 0x0F, 0x85, 0x1B, 0x85, 0x1C, 0xA9,
                       2,    0x85, 0,    0xA2, lines, 0x85, 2,    0x86, 0x08, 0xCA, 0xD0, 0xF9})
                 .fill({0xEA}, wait)
                 .put({0x86, 0x0E, 0x85, 0x1B, 0xA9, 0, 0x85, 0})
                 .jump(kStart));
  // Collision latches that are read, and never cleared.
  to.add("collisions kept",
         Bank()
             .new_frame()
             .put({0xA9, 0xFF, 0x85, 0x1B, 0x85, 0x1D, 0xA2, 240, 0x85, 2, 0xB5, 0x10, 0xCA, 0xD0, 0xF9})
             .jump(kStart));
  // An opcode fetched from a collision register: the step is run once more, access by access.
  to.add("opcodes from collision registers", Bank()
                                                 .stack()
                                                 .new_frame()
                                                 .put({0xA2, 200, 0x85, 2, 0x86, 0x1B, 0xCA, 0xD0, 0xF9})
                                                 .call(0x0030)
                                                 .jump(kStart));
}

// Code that is hot for a while, then code that runs once.
void add_hot_and_cold(Collection& to) {
  for (const unsigned turns : {1U, 8U, 64U, 255U}) {
    Bank bank;
    bank.put({0xA2, turns, 0xE6, 0x90, 0xCA, 0xD0, 0xFB});  // hot
    bank.put({0xE6, 0x80, 0xD0, 0x02, 0xE6, 0x81, 0xA5, 0x81, 0x29, 0x07, 0x09,
              0xF8, 0x85, 0x83, 0xA5, 0x80, 0x85, 0x82, 0x6C, 0x82, 0x00});
    bank.skip_to(0x800).fill({0xE8}).jump(kStart);
    to.add("hot " + std::to_string(turns) + " times, then elsewhere", bank);
  }
}

}  // namespace

std::vector<HostileProgram> hostile_programs() {
  Collection collection;
  for (const auto add : {add_storms, add_mixtures, add_fields, add_random_fields, add_bank_storms,
                         add_full_memory, add_code_in_ram, add_interrupts, add_frames, add_hot_and_cold})
    add(collection);
  return std::move(collection.all);
}

}  // namespace racebeam::test
