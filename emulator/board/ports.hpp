// The two controller ports: the levels that a program reads from their pins (docs/spec/riot.md, 5;
// docs/spec/console.md, 5; docs/spec/tia.md, 11; docs/spec/controllers.md).
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

  std::uint8_t swcha(const State& state, std::int32_t cycle) const;

  // The first cycle in which a pin, one of INPT0-5, reads high: when its capacitor is charged, or its button
  // is released.
  static constexpr unsigned kPins = 6;
  static constexpr std::uint32_t kAlways = 0, kNever = ~0U;
  std::uint32_t high_from(unsigned pin, const State& state) const;

  // Whether a controller looks at what the program writes to SWCHA.
  bool has_keyboard() const { return has(Controller::kKeyboard); }

  // Whether INPT4 or INPT5 goes low when the beam passes.
  bool has_light_gun() const { return has(Controller::kLightGun); }

  // Whether the light gun in that port (0: left) sees the beam. `origin`: the cycle at which the first line
  // of the picture starts.
  bool sees_beam(unsigned side, const Inputs& inputs, std::int32_t cycle, std::int32_t origin) const;

 private:
  struct Port {
    Controller controller;
    int player;  // 0: what the properties call left, driven by player A
  };

  bool has(Controller controller) const {
    return side_[0].controller == controller || side_[1].controller == controller;
  }
  std::uint8_t nibble(unsigned side, const State& state, std::int32_t cycle) const;
  [[gnu::noinline]] std::uint8_t other_nibble(unsigned side, const State& state, std::int32_t cycle) const;
  std::uint8_t paddle_buttons(const Inputs& inputs, const Port& port) const;
  bool button_released(unsigned side, const State& state) const;
  std::uint32_t charged_from(unsigned pin, const State& state) const;
  std::uint32_t second_button(unsigned pin, const State& state) const;
  [[gnu::noinline]] std::uint32_t other_pin(unsigned pin, const State& state) const;
  int paddle(const Port& port, int which) const { return 2 * port.player + (which ^ swap_paddles_); }

  std::array<Port, 2> side_;  // left, right
  int swap_paddles_;
};

}  // namespace racebeam
