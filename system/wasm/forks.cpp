#include "system/forks.hpp"

namespace racebeam {

void call_in_forks(void (*)()) {}  // a process cannot be copied

}  // namespace racebeam
