// Notices copies of the process, as fork() makes them.
#pragma once

namespace racebeam {

// Registers a function that the system calls in each child of fork(), before fork() returns there.
void call_in_forked_children(void (*function)());

}  // namespace racebeam
