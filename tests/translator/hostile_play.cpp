// translator_hostile                          prints the names of the hostile programs, one a line
// translator_hostile CPU NUMBER STEPS         plays one, by its number in this list from 0 on, without
// pictures; CPU is
//                                             interpreter or translator
//
// platforms/instructions counts what the second form executes.
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "tests/translator/cost.hpp"
#include "tests/translator/hostile.hpp"

int main(int argc, char** argv) {
  using namespace racebeam;
  const std::vector<test::HostileProgram> programs = test::hostile_programs();
  if (argc == 1) {
    for (const test::HostileProgram& program : programs) std::puts(program.name.c_str());
    return 0;
  }
  const int number = argc == 4 ? std::atoi(argv[2]) : -1;
  if (number < 0 || number >= static_cast<int>(programs.size())) {
    std::fprintf(stderr,
                 "usage: translator_hostile [interpreter|translator NUMBER STEPS], NUMBER below %zu\n",
                 programs.size());
    return 2;
  }
  const bool translates = std::string_view(argv[1]) == "translator";
  test::play(programs[static_cast<std::size_t>(number)].program, std::atoi(argv[3]), test::Look::kNone,
             translates ? CpuKind::kAuto : CpuKind::kInterpreter);
}
