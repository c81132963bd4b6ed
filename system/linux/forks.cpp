#include "system/forks.hpp"

#include <pthread.h>

namespace racebeam {

void call_in_forked_children(void (*function)()) { ::pthread_atfork(nullptr, nullptr, function); }

}  // namespace racebeam
