// How much of the computer this process may use. Affinity, control groups (containers) and limits of
// resources (ulimit) can limit it.
#pragma once

#include <cstdint>
#include <string>

namespace racebeam {

// An amount, and what limits it: "the affinity", "the control group", "the address space (ulimit -v)" or "the
// machine".
struct Allowance {
  std::uint64_t amount;
  std::string limited_by;
};

// Control groups (cgroups) of version 1 and 2 are found by ROOT/proc/self/cgroup and
// ROOT/proc/self/mountinfo. A group's limits hold for all groups below it, so that the whole path up the
// hierarchy counts. Files that cannot be read do not set a limit. `root` is for tests.

// The number of processors that the process may use. It is the smaller one of the number on which the process
// may run (sched_getaffinity) and the CPU quota, rounded up; at least 1.
Allowance usable_processors(const std::string& root = "");

// The bytes of memory that the process may use: the smallest of the physical memory, the limits of the
// control groups and the limit of the address space.
Allowance usable_memory(const std::string& root = "");

// Raises the limit of open files as far as the system allows. Returns how many the process may have open.
std::uint64_t usable_files();

// Sets the size of the stacks of threads that begin from now on. The default of the system may be too small
// (128 KiB with musl), or of any size (`ulimit -s`).
void set_thread_stacks();

// Returns how many of the descriptors below `most` are open.
std::uint64_t open_files(std::uint64_t most);

// Both return free memory of the heap to the system, so that a server does not keep the memory of its largest
// load. trim_heap() does so now. After return_large_blocks(), each large block is returned when it is freed:
// one as large as a picture, or as the records of its lines. They do something only with the GNU C library.
void trim_heap();
void return_large_blocks();

int process_number();

// Opens a file without contents, to reserve a descriptor for another file; close_file() frees it. Returns -1
// if a reserve is not needed.
int open_spare_file();

// Bytes of memory that the process uses now.
std::uint64_t resident_memory();

}  // namespace racebeam
