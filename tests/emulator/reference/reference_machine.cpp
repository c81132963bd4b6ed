#include "tests/emulator/reference/reference_machine.hpp"

#include <sstream>

namespace racebeam::test {

void ReferenceMachine::run(int instructions) {
  stop = false;
  for (int i = 0; i < instructions && !stop && !cpu.jammed; ++i) cpu.step();
}

// docs/spec/tia.md, 2, action 1.
void ReferenceMachine::next_frame() {
  const auto T = static_cast<std::uint32_t>(cpu.T);
  tia.open_frame(cpu.T);
  timer.Tset -= T;
  timer.R -= T;
  released_ -= T;
  finish_ -= 3 * T;
  cpu.T = 0;
}

// docs/spec/cpu.md, 2.
int ReferenceMachine::read(int address, int T) {
  if (address & 0x1000) return access(rom_[static_cast<std::size_t>(address & 0xFFF)]);
  if (!(address & 0x80)) return access(read_tia(address & 15, T));
  if (!(address & 0x200)) return access(ram[static_cast<std::size_t>(address & 0x7F)]);
  switch (address & 7) {
    case 0: return access(0xFF);
    case 1: return access(swacnt_);
    case 2: return access(0x3F);
    case 3: return access(0);
    default: return access(read_timer(address, static_cast<std::uint32_t>(T)));
  }
}

int ReferenceMachine::write(int address, int value, int T, bool after_read) {
  latch = value;
  if (address & 0x1000) return T;
  if (!(address & 0x80)) return write_tia(address & 0x3F, value, T, after_read);
  if (!(address & 0x200)) {
    ram[static_cast<std::size_t>(address & 0x7F)] = value;
    return T;
  }
  static constexpr int kShift[4] = {0, 3, 6, 10};
  if ((address & 7) == 1) swacnt_ = value;
  if ((address & 7) >= 4 && (address & 0x10))
    timer = {value, kShift[address & 3], static_cast<std::uint32_t>(T), timer.R, false};
  return T;
}

// docs/spec/riot.md, 3.
int ReferenceMachine::read_timer(int address, std::uint32_t T) {
  const std::uint32_t D = T - 1 - timer.Tset, E = static_cast<std::uint32_t>(timer.V) << timer.s;
  const auto k = static_cast<std::int32_t>(static_cast<std::uint32_t>(timer.V) - (D >> timer.s) - 1);
  if (address & 1) return k < 0 && !timer.late ? 0x80 : 0;
  if (k >= 0) return k & 0xFF;
  if (!timer.late && D == E) return 0xFF;
  if (!timer.late) {
    timer.late = true;
    timer.R = T;
  }
  return static_cast<int>(
      (static_cast<std::uint32_t>(timer.V) - (D >> timer.s) - (timer.R - (timer.Tset + E))) & 0xFF);
}

// docs/spec/tia.md, 11: no pots, no button pressed.
int ReferenceMachine::read_tia(int reg, int T) {
  int driven = reg == 12 || reg == 13 ? 0x80 : 0;
  if (reg < 8)
    driven = static_cast<int>(tia.read(T, static_cast<unsigned>(reg)));
  else
    tia.touch(T);
  return driven | (latch & 0x3F);
}

// docs/spec/tia.md, 2 and 4.
int ReferenceMachine::write_tia(int reg, int value, int T, bool after_read) {
  tia.write(T, static_cast<unsigned>(reg), static_cast<std::uint8_t>(value));
  const auto c = static_cast<std::uint32_t>(3 * T);
  if ((3 * T - tia.origin()) / 228 > 290) stop = true;
  if (reg == 0 && (value & 2)) finish_ = c + 228;
  if (reg == 0 && !(value & 2) && static_cast<std::int32_t>(c) >= static_cast<std::int32_t>(finish_)) {
    finish_ = 0x7FFFFFFF;
    stop = true;
  }
  if (reg == 1) {
    if (dumping_ && !(value & 0x80)) released_ = static_cast<std::uint32_t>(T);
    dumping_ = (value & 0x80) != 0;
  }
  const int into = (T - tia.origin() / 3) % 76;
  return reg == 2 && after_read && into != 0 ? T + 76 - into : T;
}

std::string ReferenceMachine::difference(const State& state) const {
  std::ostringstream out;
  out << std::hex;
  const auto check = [&out](const char* name, long ours, long theirs) {
    if (ours != theirs) out << name << " $" << ours << ", not $" << theirs << "; ";
  };
  check("T", state.cycle, cpu.T);
  check("PC", state.cpu.PC, cpu.PC);
  check("A", state.cpu.A, cpu.A);
  check("X", state.cpu.X, cpu.X);
  check("Y", state.cpu.Y, cpu.Y);
  check("SP", state.cpu.SP, cpu.SP);
  check("P", state.cpu.P | 0x30, cpu.status());
  check("jammed", state.cpu.jammed, cpu.jammed);
  check("bus latch", state.cpu.latch, latch);
  for (std::size_t i = 0; i < ram.size(); ++i)
    if (state.riot.ram[i] != ram[i])
      check(("RAM " + std::to_string(0x80 + i)).c_str(), state.riot.ram[i], ram[i]);
  check("timer", state.riot.timer, timer.V);
  check("interval", state.riot.shift, timer.s);
  check("timer set", state.riot.timer_set, timer.Tset);
  check("late", state.riot.late, timer.late);
  if (timer.late) check("late read", state.riot.late_read, timer.R);
  check("SWACNT", state.riot.swacnt, swacnt_);
  check("dump", state.frame.dumping, dumping_);
  check("dump release", state.frame.dump_release, released_);
  check("VSYNC finish", state.frame.vsync_finish, finish_);
  return out.str() + tia.difference(state.tia);
}

}  // namespace racebeam::test
