// Copies of the process.
#pragma once

namespace racebeam {

// The system calls `function` in each process that begins as a copy of this one, before fork() returns there.
void call_in_forks(void (*function)());

}  // namespace racebeam
