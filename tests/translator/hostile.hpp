// Programs that try to make the translator slow, each in a different way.
#pragma once

#include <string>
#include <vector>

#include "tests/translator/random_program.hpp"

namespace racebeam::test {

struct HostileProgram {
  std::string name;
  Program program;
};

// Returns a hundred or more, the same on every machine.
std::vector<HostileProgram> hostile_programs();

}  // namespace racebeam::test
