// How much of the computer this process may use. Affinity, control groups (containers) and limits of
// resources (ulimit) can limit it.
#pragma once

#include <cstdint>
#include <string>

namespace racebeam {

// An amount, and its limit: "the affinity", "the control group", "the address space (ulimit -v)" or "the
// machine".
struct Allowance {
  std::uint64_t amount;
  std::string limited_by;
};

// Control groups (cgroups) of version 1 and 2 are found by ROOT/proc/self/cgroup and
// ROOT/proc/self/mountinfo. A group's limits hold for all groups below it, so that the whole path up the
// hierarchy counts. Files that cannot be read set no limit. `root` is for tests.

// Processors: the least of those that the process may run on (sched_getaffinity) and the CPU quota, rounded
// up. At least 1.
Allowance usable_processors(const std::string& root = "");

// Bytes: the least of the physical memory, the control groups' limits and that of the address space.
Allowance usable_memory(const std::string& root = "");

// Raises the limit of open files as far as the system allows. Returns how many the process may have open.
std::uint64_t usable_files();

// Sets the size of the stacks of threads that begin from now on. The system's own size may be too small (128
// KiB with musl), or anything (`ulimit -s`).
void set_thread_stacks();

// How many of its first `most` files the process has open now.
std::uint64_t open_files(std::uint64_t most);

// Gives memory of the heap that is free back to the system, now, or from now on each large block: those as
// large as a picture, or as the records of its lines. Otherwise a server would keep the memory of its largest
// load. Only the GNU C library can be told.
void trim_heap();
void return_large_blocks();

int process_number();

// Opens a file that has nothing, so that there is a number for another one after close_file(); -1 if none is
// needed.
int open_spare_file();

// Bytes of memory that the process uses now.
std::uint64_t resident_memory();

}  // namespace racebeam
