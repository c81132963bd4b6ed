// The two controller ports: which pin reads what (docs/spec/riot.md, 5; docs/spec/console.md, 5;
// docs/spec/tia.md, 11).
#pragma once

#include <array>
#include <cstdint>

#include "emulator/state/inputs.hpp"
#include "emulator/state/properties.hpp"
#include "emulator/state/state.hpp"

namespace racebeam {

class Ports {
 public:
  explicit Ports(const Properties& properties);

  std::uint8_t swcha(const Inputs& inputs) const;

  // The first cycle in which INPT0-5 read high: as soon as a capacitor is charged, or a button released.
  static constexpr unsigned kPins = 6;
  static constexpr std::uint32_t kAlways = 0, kNever = ~0U;
  std::uint32_t high_from(unsigned pin, const Inputs& inputs, const FrameState& frame) const;

 private:
  struct Port {
    Controller controller;
    int player;  // 0: what the properties call left, driven by player A
  };

  std::uint8_t nibble(const Inputs& inputs, const Port& port) const;
  bool button_released(const Inputs& inputs, const Port& port) const;
  int paddle(const Port& port, int which) const { return 2 * port.player + (which ^ swap_paddles_); }

  std::array<Port, 2> side_;  // left, right
  int swap_paddles_;
};

}  // namespace racebeam
