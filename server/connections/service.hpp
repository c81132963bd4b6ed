// What a server offers: machines, and how to talk to them.
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "environment/environment.hpp"
#include "protocol/classic/paced_classic.hpp"
#include "protocol/line_session.hpp"

namespace racebeam {

using Service = std::variant<ClassicService, LineService>;

// One for each protocol that is spoken on some endpoint.
struct Services {
  std::optional<Service> classic, line;
};

// For the log: a session can be played again when its seed is known.
inline std::string describe(const Environment& machine) {
  return machine.game().name + ", seed " + std::to_string(machine.settings().random_seed);
}

}  // namespace racebeam
