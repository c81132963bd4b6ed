// The services of a server: machines, and the protocols for them.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "environment/environment.hpp"
#include "protocol/classic/paced_classic.hpp"
#include "protocol/line_session.hpp"

namespace racebeam {

using Service = std::variant<ClassicService, LineService>;

// The services of the two protocols. A protocol that no endpoint uses has nothing here.
struct Services {
  std::optional<Service> classic, line;
};

// The budget of the sessions of a service; null: unlimited.
inline const std::shared_ptr<MemoryBudget>& memory_of(const Service& service) {
  return std::visit(
      [](const auto& kind) -> const auto& { return kind.memory; }, service);
}

// Describes a session for the log, with the seed that is needed to repeat it.
inline std::string describe(const Environment& machine) {
  return machine.game().name + ", seed " + std::to_string(machine.settings().random_seed);
}

}  // namespace racebeam
