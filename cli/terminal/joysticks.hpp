// The keys of two players, as the actions of their joysticks.
#pragma once

#include <array>
#include <chrono>
#include <string>

#include "cli/terminal/input.hpp"

namespace racebeam {

// Player A has the arrows and the space bar, player B has W, A, S, D and G.
class Joysticks {
 public:
  using Time = std::chrono::steady_clock::time_point;

  // How long a key counts as pressed if the terminal does not tell when it is released.
  static constexpr std::chrono::milliseconds kHeld{200};

  explicit Joysticks(bool releases_are_told) : releases_are_told_(releases_are_told) {}

  // A direction ends the opposite one. Other keys have no effect.
  void handle(const TerminalEvent& event, Time now);

  // The action for `act` of the line protocol, such as UPFIRE/LEFT.
  std::string action(Time now) const;

 private:
  static constexpr std::size_t kPlayers = 2, kSwitches = 5;

  std::string action_of(std::size_t player, Time now) const;

  bool releases_are_told_;
  std::array<std::array<Time, kSwitches>, kPlayers> pressed_until_{};
};

}  // namespace racebeam
