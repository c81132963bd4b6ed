#include "system/program/parent_process.hpp"

#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

namespace racebeam {

bool end_with_parent(int parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  return ::getppid() == parent;
}

}  // namespace racebeam
