// Each row of registers.inc against the writes themselves, on random registers: no column says too little or
// too much. What the column `late` says depends on the end of a line; tia_random_test.cpp covers it.
#include <catch2/catch.hpp>

#include <algorithm>
#include <bit>
#include <random>
#include <string>
#include <vector>

#include "emulator/tia/line_cache/line_dependencies.hpp"
#include "emulator/tia/register_effects.hpp"
#include "emulator/tia/registers/register_bytes.hpp"

namespace racebeam::test {
namespace {

constexpr const char* kNames[] = {
#define REGISTER(name, ...) #name,
#include "emulator/tia/registers/registers.inc"
#undef REGISTER
};

constexpr int kTries = 20000;

// What a policy is told of a write (render_policies.hpp). It draws nothing, so that only the writes change
// registers.
struct Effects {
  std::int32_t clock = -1000;  // the latest that was named
  bool cleared = false;        // the collisions
};

struct Listener {
  Effects& effects;
  bool compares;

  void reach(std::int32_t clock) const { effects.clock = std::max(effects.clock, clock); }
  void draw_to(std::int32_t clock, unsigned) const { reach(clock); }
  void draw_before(std::int32_t clock, const PlayfieldPart&) const { reach(clock); }
  void advance_to(std::int32_t clock) const { reach(clock); }
  void collide_to(std::int32_t clock) const { reach(clock); }
  bool is_active() const { return compares; }
  static bool tracks(unsigned) { return false; }
  void changed(std::uint8_t) const {}
  void enabled_changed() const {}
  void clear_collisions() const { effects.cleared = true; }
};

class Trial {
 public:
  explicit Trial(unsigned seed) : random_(seed) {}

  int below(int end) { return std::uniform_int_distribution<int>(0, end - 1)(random_); }
  std::uint8_t byte(int end = 256) { return static_cast<std::uint8_t>(below(end)); }
  template <class T, std::size_t kSize>
  T any_of(const T (&values)[kSize]) {
    return values[below(kSize)];
  }

  // A write somewhere on a line; values that switch things occur often.
  TiaWrite write(unsigned reg) { return write(reg, below(kLineCycles)); }
  TiaWrite write(unsigned reg, std::int32_t cycle) {
    return {cycle, reg, below(2) == 0 ? byte() : any_of<std::uint8_t>({0x00, 0x02, 0x60, 0x70, 0xFF})};
  }

  TiaRegisters registers() {
    TiaRegisters tia;
    for (std::uint8_t& color : tia.color) color = byte() & 0xFE;
    for (std::uint8_t& pf : tia.pf) pf = below(2) == 0 ? 0 : byte();
    tia.ctrlpf = byte() & 0x37;
    tia.reflect = byte(2);
    for (PlayerState& player : tia.player) {
      player = {graphics(), graphics(), byte(2), byte(2), static_cast<std::uint8_t>(byte() & 0x37),
                byte(160),  motion(),   byte(2)};
    }
    for (MissileState& missile : tia.missile) missile = {byte(2), byte(2), byte(160), motion()};
    tia.ball = {byte(2), byte(2), byte(2), byte(160), motion()};
    tia.vblank = byte(2);
    tia.comb_armed = byte(2);
    tia.cosmic = byte(2);
    tia.cosmic_count = byte(4);
    tia.cosmic_shape = tia.cosmic ? static_cast<CosmicShape>(below(3)) : CosmicShape::kNormal;
    return tia;
  }

  // When the last HMOVE was: often where RESMx, RESBL and HMM0 take notice.
  std::uint32_t hmove_clock(TiaWrite write) {
    return static_cast<std::uint32_t>(3 * write.cycle() - any_of({9, 18, 54, 60, 63, 63, 63, 1000}));
  }

 private:
  std::uint8_t graphics() { return below(2) == 0 ? 0 : byte(); }
  std::uint8_t motion() { return below(2) == 0 ? byte(16) : any_of<std::uint8_t>({0, 6, 7}); }

  std::mt19937 random_;
};

struct Played {
  TiaBytes bytes;
  Effects effects;
};

Played play(const TiaRegisters& registers, std::uint32_t hmove_clock, const std::vector<TiaWrite>& writes,
            bool compares) {
  TiaState tia;
  tia.registers() = registers;
  tia.hmove_clock = hmove_clock;
  Played played;
  std::vector<std::uint32_t> log;
  for (const TiaWrite write : writes) log.push_back(write.packed());
  RegisterEffects<Listener>(tia, FrameState{}, Video{}, {played.effects, compares})
      .play(log.data(), log.data() + log.size(), 0);
  played.bytes = std::bit_cast<TiaBytes>(tia.registers());
  return played;
}

TiaBytes bytes_of(const TiaRegisters& registers) { return std::bit_cast<TiaBytes>(registers); }

// `registers` with the bytes of `mask` taken from `source`.
TiaRegisters with(const TiaRegisters& registers, const TiaRegisters& mask, const TiaRegisters& source) {
  TiaBytes result = bytes_of(registers);
  const TiaBytes chosen = bytes_of(mask), from = bytes_of(source);
  for (std::size_t i = 0; i < result.size(); ++i)
    if (chosen[i] != 0) result[i] = from[i];
  return std::bit_cast<TiaRegisters>(result);
}

TiaRegisters one_byte(std::size_t i) {
  TiaBytes bytes{};
  bytes[i] = 0xFF;
  return std::bit_cast<TiaRegisters>(bytes);
}

std::vector<unsigned> picture_registers() {
  std::vector<unsigned> all;
  for (unsigned reg = 0; reg < kTiaRegisters; ++reg)
    if (kRegisters[reg].use == RegisterUse::kPicture) all.push_back(reg);
  return all;
}

TEST_CASE("A write sets what its row says, from what its row says, and touches nothing else") {
  Trial trial(1);
  for (const unsigned reg : picture_registers()) {
    const RegisterBytes& row = kRegisterBytes[reg];
    const TiaBytes sets = bytes_of(row.sets), may_set = bytes_of(row.may_set);
    bool holds = true;
    for (int i = 0; i < kTries && holds; ++i) {
      const TiaWrite write = trial.write(reg);
      const std::uint32_t hmove = trial.hmove_clock(write);
      const TiaRegisters one = trial.registers();
      const TiaRegisters other = with(trial.registers(), row.reads | row.may_set, one);
      const TiaBytes before = bytes_of(one), before_other = bytes_of(other);
      const TiaBytes after = play(one, hmove, {write}, i % 2 == 0).bytes;
      const TiaBytes after_other = play(other, hmove, {write}, i % 2 == 0).bytes;
      for (std::size_t byte = 0; byte < after.size(); ++byte) {
        const bool is_listed = (sets[byte] | may_set[byte]) != 0;
        holds &= is_listed ? after[byte] == after_other[byte]
                           : after[byte] == before[byte] && after_other[byte] == before_other[byte];
      }
    }
    INFO(kNames[reg]);
    CHECK(holds);
  }
}

// Is there a case in which only this byte makes a difference to `bytes` after the write?
bool matters(Trial& trial, unsigned reg, std::size_t byte, const TiaRegisters& bytes) {
  const TiaBytes chosen = bytes_of(bytes);
  for (int i = 0; i < kTries; ++i) {
    const TiaWrite write = trial.write(reg);
    const std::uint32_t hmove = trial.hmove_clock(write);
    const TiaRegisters one = trial.registers(), other = with(one, one_byte(byte), trial.registers());
    const TiaBytes after = play(one, hmove, {write}, false).bytes,
                   after_other = play(other, hmove, {write}, false).bytes;
    for (std::size_t at = 0; at < after.size(); ++at)
      if (chosen[at] != 0 && after[at] != after_other[at]) return true;
  }
  return false;
}

bool changes(Trial& trial, unsigned reg, std::size_t byte) {
  for (int i = 0; i < kTries; ++i) {
    const TiaWrite write = trial.write(reg);
    const TiaRegisters one = trial.registers();
    if (play(one, trial.hmove_clock(write), {write}, false).bytes[byte] != bytes_of(one)[byte]) return true;
  }
  return false;
}

TEST_CASE("No row of the table lists a byte without need") {
  Trial trial(2);
  for (const unsigned reg : picture_registers()) {
    const RegisterBytes& row = kRegisterBytes[reg];
    const TiaBytes sets = bytes_of(row.sets), may_set = bytes_of(row.may_set), reads = bytes_of(row.reads);
    for (std::size_t byte = 0; byte < sets.size(); ++byte) {
      INFO(kNames[reg] << ", byte " << byte);
      if ((sets[byte] | may_set[byte]) != 0) CHECK(changes(trial, reg, byte));
      if (may_set[byte] != 0) CHECK(matters(trial, reg, byte, one_byte(byte)));  // it may be kept
      if (reads[byte] != 0) CHECK(matters(trial, reg, byte, row.sets | row.may_set));
    }
  }
}

TEST_CASE("The delay of a write is the longest that the picture hears of") {
  Trial trial(3);
  for (const unsigned reg : picture_registers()) {
    std::int32_t longest = -1000;
    for (int i = 0; i < kTries; ++i) {
      const TiaWrite write = trial.write(reg);
      const Effects events = play(trial.registers(), trial.hmove_clock(write), {write}, i % 2 == 0).effects;
      longest = std::max(longest, events.clock - 3 * write.cycle());
    }
    INFO(kNames[reg]);
    CHECK(longest == kRegisters[reg].delay);
  }
}

// May `between` come between two writes of the same value to `reg` without a say in the second? The log
// forgets the value of a register that HMCLR overwrites.
bool leaves_alone(unsigned between, unsigned reg) {
  if (between == reg || kRegisters[between].renews == reg) return false;
  return kRegisters[reg].repeat == OnRepeat::kActs ||
         !share_a_byte(kRegisterBytes[between].sets, kRegisterBytes[reg].sets);
}

// Does the second of two writes of one value act, with writes to these registers between them?
bool acts_again(Trial& trial, unsigned reg, const std::vector<unsigned>& between, bool compares) {
  std::vector<TiaWrite> writes = {trial.write(reg)};
  const std::uint32_t hmove = trial.hmove_clock(writes[0]);
  std::int32_t cycle = writes[0].cycle();
  for (const unsigned other : between)
    writes.push_back(trial.write(other, cycle += trial.any_of({3, 21, 30})));
  const TiaRegisters start = trial.registers();
  const TiaBytes before = play(start, hmove, writes, compares).bytes;
  writes.emplace_back(cycle + trial.any_of({3, 21, 30}), reg, writes[0].value());
  return play(start, hmove, writes, compares).bytes != before ||
         reg == CXCLR;  // which sets no byte, and clears collisions
}

TEST_CASE("A repeated write acts only where the table says so") {
  Trial trial(4);
  const std::vector<unsigned> all = picture_registers();
  for (const unsigned reg : all) {
    INFO(kNames[reg]);
    std::vector<unsigned> others;
    std::copy_if(all.begin(), all.end(), std::back_inserter(others),
                 [reg](unsigned other) { return leaves_alone(other, reg); });
    bool acts = false;
    for (int i = 0; i < kTries; ++i) {
      std::vector<unsigned> between;
      for (int n = trial.below(5); n > 0; --n)
        between.push_back(others[static_cast<std::size_t>(trial.below(static_cast<int>(others.size())))]);
      acts |= acts_again(trial, reg, between, i % 2 == 0);
    }
    CHECK(acts == (kRegisters[reg].repeat == OnRepeat::kActs));
  }
}

TEST_CASE("The bits of a value that a row names matter, and no others, except that PF0 keeps all") {
  Trial trial(7);
  for (const unsigned reg : picture_registers()) {
    unsigned matter = 0;
    for (int i = 0; i < kTries; ++i) {
      const TiaWrite write = trial.write(reg);
      const unsigned bit = 1U << trial.below(8);
      const TiaWrite other(write.cycle(), reg, static_cast<std::uint8_t>(write.value() ^ bit));
      const TiaRegisters start = trial.registers();
      const std::uint32_t hmove = trial.hmove_clock(write);
      const Played one = play(start, hmove, {write}, i % 2 == 0),
                   two = play(start, hmove, {other}, i % 2 == 0);
      if (one.bytes != two.bytes || one.effects.clock != two.effects.clock) matter |= bit;
    }
    INFO(kNames[reg]);
    CHECK(matter == kRegisters[reg].bits);
  }
}

TEST_CASE("A write renews the register that its row names") {
  Trial trial(5);
  for (const unsigned reg : picture_registers()) {
    const unsigned renewed = kRegisters[reg].renews;
    if (renewed == kNone) continue;
    bool acts = false;
    for (int i = 0; i < kTries && !acts; ++i) acts = acts_again(trial, renewed, {reg}, true);
    INFO(kNames[reg] << " renews " << kNames[renewed]);
    CHECK(acts);
  }
}

TEST_CASE("A write enables or disables the objects that it controls, and no other") {
  Trial trial(6);
  for (const unsigned reg : picture_registers()) {
    unsigned changed = 0;
    for (int i = 0; i < kTries; ++i) {
      const TiaWrite write = trial.write(reg);
      const TiaRegisters before = trial.registers();
      const auto after =
          std::bit_cast<TiaRegisters>(play(before, trial.hmove_clock(write), {write}, false).bytes);
      changed |= enabled_among(before, kAllObjects) ^ enabled_among(after, kAllObjects);
    }
    INFO(kNames[reg]);
    CHECK(changed == (kLineEffects[reg].control & kAllObjects));
  }
}

}  // namespace
}  // namespace racebeam::test
