#include "system/affinity.hpp"

#include <string>

#include "system/invalid_input.hpp"

namespace racebeam {

std::vector<unsigned> allowed_processors() { return {}; }

void bind_to(std::jthread&, unsigned processor) {
  throw InvalidInput("a thread could not be bound to processor " + std::to_string(processor) +
                     ": macOS binds no thread to a processor");
}

}  // namespace racebeam
