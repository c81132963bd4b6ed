// Programs that were written to make the translator slow, each in its own way.
#pragma once

#include <string>
#include <vector>

#include "tests/translator/program.hpp"

namespace racebeam::test {

struct HostileProgram {
  std::string name;
  Program program;
};

// A hundred or more, the same on every machine.
std::vector<HostileProgram> hostile_programs();

}  // namespace racebeam::test
