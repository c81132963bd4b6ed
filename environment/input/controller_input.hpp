// Applies actions to the console's ports and switches (docs/spec/environment.md, 2; docs/spec/console.md, 5;
// docs/spec/controllers.md).
#pragma once

#include <array>
#include <cstdint>

#include "emulator/state/inputs.hpp"
#include "emulator/state/properties.hpp"
#include "environment/input/console_switches.hpp"
#include "environment/input/effective_actions.hpp"
#include "environment/input/paddles.hpp"

namespace racebeam {

class ControllerInput {
 public:
  ControllerInput(const Properties& properties, PaddleLimits limits)
      : controllers_{properties.left, properties.right}, limits_(limits) {}

  const PaddleLimits& limits() const { return limits_; }
  PaddleValues middle() const;  // where paddles, wheels and guns are when an episode begins

  // For one frame. An unknown action presses nothing; player A's may press RESET or SELECT.
  void press(Inputs& inputs, const Presses& presses, const ConsoleSwitches& switches,
             PaddleValues& paddles) const;

  // Holds only SELECT. The paddles keep their positions.
  static void press_select(Inputs& inputs, const ConsoleSwitches& switches);

 private:
  bool use_paddles() const {
    return controllers_[0] == Controller::kPaddles || controllers_[1] == Controller::kPaddles;
  }
  void turn_paddles(Inputs& inputs, const Presses& presses, PaddleValues& paddles) const;

  std::array<Controller, 2> controllers_;  // player A's, player B's
  PaddleLimits limits_;
};

}  // namespace racebeam
