// Applies actions to the console's ports and switches (docs/spec/environment.md, 2; docs/spec/console.md, 5).
#pragma once

#include <cstdint>

#include "emulator/state/inputs.hpp"
#include "environment/input/console_switches.hpp"
#include "environment/input/effective_actions.hpp"
#include "environment/input/paddles.hpp"

namespace racebeam {

class ControllerInput {
 public:
  ControllerInput(bool use_paddles, PaddleLimits limits) : use_paddles_(use_paddles), limits_(limits) {}

  const PaddleLimits& limits() const { return limits_; }
  PaddleValues middle() const { return limits_.middle(); }

  // For one frame. An unknown action presses nothing; player A's may press RESET or SELECT.
  void press(Inputs& inputs, const Presses& presses, const ConsoleSwitches& switches,
             PaddleValues& paddles) const;

  // Holds only SELECT. The paddles keep their positions.
  static void press_select(Inputs& inputs, const ConsoleSwitches& switches);

 private:
  void turn_paddles(Inputs& inputs, const Presses& presses, PaddleValues& paddles) const;

  bool use_paddles_;
  PaddleLimits limits_;
};

}  // namespace racebeam
