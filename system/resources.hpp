// What this process may use of the computer. That is less than there is where it was pinned, or runs in a
// container.
#pragma once

#include <cstdint>
#include <string>

namespace racebeam {

// An amount, and what limits it: "the affinity", "the control group" or "the machine".
struct Allowance {
  std::uint64_t amount;
  std::string limited_by;
};

// Control groups (cgroups) of version 1 and 2 are found by ROOT/proc/self/cgroup and
// ROOT/proc/self/mountinfo. The limits of a group hold for all groups below it, so the whole path up the
// hierarchy counts. What can't be read is no limit. `root` is for tests.

// Processors: the least of those that the process may run on (sched_getaffinity) and the CPU quota, rounded
// up. At least 1.
Allowance usable_processors(const std::string& root = "");

// Bytes: the least of the physical memory and the control groups' limits.
Allowance usable_memory(const std::string& root = "");

// Bytes of memory that the process has now.
std::uint64_t resident_memory();

}  // namespace racebeam
