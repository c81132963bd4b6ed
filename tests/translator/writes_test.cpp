// Translated code and the interpreter log the same writes. block_writes.cpp and the code generators do what
// WriteLog::append() and append_change() do. The frame tests would miss a record too many.
#include <algorithm>
#include <catch2/catch.hpp>
#include <initializer_list>
#include <memory>
#include <vector>

#include "emulator/translator/translator.hpp"
#include "tests/emulator/bench.hpp"
#include "tests/support/skip.hpp"

namespace racebeam::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr unsigned kRegisters = 64;  // also the addresses that have none
constexpr std::int32_t kInstructions = 25000;

// Every bit of a register, and all of them.
constexpr std::initializer_list<unsigned> kValues = {0x00, 0x01, 0x02, 0x04, 0x08,
                                                     0x10, 0x20, 0x40, 0x80, 0xFF};

// How the value gets to the register.
enum class Store { kSta, kStx, kSty, kAbsolute, kIndexed };

void add(Bytes& code, std::initializer_list<unsigned> more) {
  for (const unsigned byte : more) code.push_back(static_cast<std::uint8_t>(byte));
}

void load(Bytes& code, Store store, unsigned value) {
  switch (store) {
    case Store::kStx: return add(code, {0xA2, value});
    case Store::kSty: return add(code, {0xA0, value});
    case Store::kIndexed: return add(code, {0xA9, value, 0xA2, 0x01});  // LDX #1
    default: return add(code, {0xA9, value});
  }
}

void write(Bytes& code, Store store, unsigned reg) {
  switch (store) {
    case Store::kSta: return add(code, {0x85, reg});
    case Store::kStx: return add(code, {0x86, reg});
    case Store::kSty: return add(code, {0x84, reg});
    case Store::kAbsolute: return add(code, {0x8D, reg, 0x00});
    case Store::kIndexed: return add(code, {0x95, (reg - 1) & 0xFFU});
  }
}

// Writes `value` to `reg` twice, and once more after every other register has had it. The repeated writes
// show what the log knew. One turn is 14 cycles or more, so that the writes come at all places of a line.
// VSYNC is the last one, because it may close the frame.
Rom program(Store store, unsigned reg, unsigned value) {
  Bytes code;
  for (unsigned other = kRegisters; other-- > 0;) {
    load(code, store, value);
    for (const unsigned target : {reg, reg, other, reg}) write(code, store, target);
    if (other % 2 == 1) add(code, {0x24, 0x80});  // BIT $80, 3 cycles
  }
  add(code, {0x02});  // halts
  Rom rom(4096, 0x02);
  std::ranges::copy(code, rom.begin());
  rom[0xFFC] = 0x00, rom[0xFFD] = 0xF0;
  return rom;
}

// A machine that runs a program up to the end of its step, and leaves the log as it is.
class Machine {
 public:
  Machine(const Rom& rom, CpuKind kind)
      : bench_(rom), translator_(Translator::make(bench_.board, kind)), log_(std::make_unique<WriteLog>()) {
    bench_.board.begin_step(bench_.picture(), nullptr, *log_, RenderMode::kNone);
    if (translator_ != nullptr)
      translator_->run(bench_.board, kInstructions);
    else
      interpret(bench_.board, kInstructions);
  }

  std::vector<TiaWrite> writes() const {
    std::vector<TiaWrite> all;
    for (std::size_t i = 0; i < log_->size(); ++i) all.emplace_back(log_->entry[i]);
    return all;
  }
  const State& state() const { return bench_.state; }
  std::int64_t interpreted_cycles() const { return translator_->interpreted_cycles(); }

 private:
  Bench bench_;
  std::unique_ptr<Translator> translator_;  // null: interpreted
  std::unique_ptr<WriteLog> log_;
};

// What differs first; empty if nothing does.
std::string difference(const std::vector<TiaWrite>& interpreted, const std::vector<TiaWrite>& translated) {
  const auto text = [](const std::vector<TiaWrite>& all, std::size_t i) {
    if (i >= all.size()) return std::string("none");
    return "register " + std::to_string(all[i].reg()) + " = " + std::to_string(all[i].value()) +
           " in cycle " + std::to_string(all[i].cycle());
  };
  for (std::size_t i = 0; i < std::max(interpreted.size(), translated.size()); ++i) {
    const std::string left = text(interpreted, i), right = text(translated, i);
    if (left != right)
      return "record " + std::to_string(i) + ": " + left + " interpreted, " + right + " translated";
  }
  return {};
}

void compare(Store store) {
  std::size_t records = 0, whole = 0;
  std::int64_t cycles = 0, left_to_interpreter = 0;
  for (unsigned reg = 0; reg < kRegisters; ++reg) {
    for (const unsigned value : kValues) {
      const Rom rom = program(store, reg, value);
      const Machine interpreted(rom, CpuKind::kInterpreter), translated(rom, CpuKind::kTranslator);
      CAPTURE(reg, value);
      REQUIRE(difference(interpreted.writes(), translated.writes()) == "");
      REQUIRE(interpreted.state().cycle == translated.state().cycle);
      whole += translated.state().cpu.jammed;
      records += interpreted.writes().size();
      cycles += translated.state().cycle;
      left_to_interpreter += translated.interpreted_cycles();
    }
  }
  CHECK(records > 40000);
  CHECK(whole > 570);  // of 640; VSYNC ends the others
  CHECK(left_to_interpreter < cycles / 20);
}

TEST_CASE("Translated code logs the writes that the interpreter logs, at every register") {
  if (Translator::obstacle()[0] != '\0') return leave_out(Translator::obstacle());
  compare(Store::kSta);
  compare(Store::kStx);
  compare(Store::kSty);
  compare(Store::kAbsolute);
  compare(Store::kIndexed);
}

}  // namespace
}  // namespace racebeam::test
