#include "system/forks.hpp"

namespace racebeam {

void call_in_forked_children(void (*)()) {}  // a process cannot be copied

}  // namespace racebeam
