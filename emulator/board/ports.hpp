// The two controller ports: which pin reads what (docs/spec/riot.md, 5; docs/spec/console.md, 5;
// docs/spec/tia.md, 11).
#pragma once

#include <array>
#include <cstdint>

#include "emulator/state/inputs.hpp"
#include "emulator/state/properties.hpp"

namespace racebeam {

class Ports {
 public:
  explicit Ports(const Properties& properties);

  std::uint8_t swcha(const Inputs& inputs) const;
  bool fire_pin(const Inputs& inputs, int side) const;  // INPT4, INPT5: true is released

  // INPT0-3: whether the capacitor is charged at `cycle`, if it was released at `release`.
  bool pot(const Inputs& inputs, int number, std::uint32_t cycle, std::uint32_t release, bool dumping) const;

 private:
  struct Port {
    Controller controller;
    int player;  // 0: what the properties call left, driven by player A
  };

  std::uint8_t nibble(const Inputs& inputs, const Port& port) const;
  int paddle(const Port& port, int which) const { return 2 * port.player + (which ^ swap_paddles_); }

  std::array<Port, 2> side_;  // left, right
  int swap_paddles_;
};

}  // namespace racebeam
