// A whole machine with a plain 4K cartridge and two released joysticks, from docs/spec/cpu.md,
// docs/spec/riot.md and docs/spec/tia.md. It has the models of the 6507 and of the TIA, with RAM, timer,
// decoding and frames.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "emulator/state/state.hpp"
#include "tests/emulator/reference/reference_cpu.hpp"
#include "tests/emulator/reference/reference_tia.hpp"

namespace racebeam::test {

class ReferenceMachine : public Bus {
 public:
  ReferenceMachine(std::vector<std::uint8_t> rom, const ReferenceTia::Window& window)
      : tia(window), rom_(std::move(rom)) {
    tia.open_frame(0);
  }

  ReferenceCpu cpu{*this};
  ReferenceTia tia;
  std::array<int, 128> ram{};
  int latch = 0;
  struct {
    int V = 0, s = 0;
    std::uint32_t Tset = 0, R = 0;
    bool late = false;
  } timer;
  bool stop = false;

  void run(int instructions);
  void next_frame();
  std::string difference(const State& state) const;

 private:
  int read(int address, int T) override;
  int write(int address, int value, int T, bool after_read) override;
  int read_tia(int reg, int T);
  int write_tia(int reg, int value, int T, bool after_read);
  int read_timer(int address, std::uint32_t T);
  int access(int value) { return latch = value; }

  std::vector<std::uint8_t> rom_;
  int swacnt_ = 0;
  std::uint32_t finish_ = 0x7FFFFFFF, released_ = 0;
  bool dumping_ = false;
};

}  // namespace racebeam::test
