#include "system/resources.hpp"

#include <windows.h>

#include <psapi.h>

#include <algorithm>
#include <cstdio>

#include "system/affinity.hpp"

namespace racebeam {
namespace {

constexpr auto kMachine = "the machine";
constexpr auto kAffinity = "the affinity";
constexpr auto kAddressSpace = "the address space";

}  // namespace

Allowance usable_processors(const std::string&) {
  const std::uint64_t all = std::max<DWORD>(1, GetActiveProcessorCount(ALL_PROCESSOR_GROUPS));
  const std::uint64_t pinned = allowed_processors().size();
  return pinned > 0 && pinned < all ? Allowance{pinned, kAffinity} : Allowance{all, kMachine};
}

Allowance usable_memory(const std::string&) {
  MEMORYSTATUSEX memory{};
  memory.dwLength = sizeof memory;
  GlobalMemoryStatusEx(&memory);
  if (memory.ullTotalVirtual < memory.ullTotalPhys) return {memory.ullTotalVirtual, kAddressSpace};
  return {memory.ullTotalPhys, kMachine};
}

// Sockets are handles, and a process may have 16 million of these. The C library also limits its own files.
std::uint64_t usable_files() {
  constexpr int kHighest = 8192;
  constexpr std::uint64_t kHandles = 1 << 24;
  _setmaxstdio(kHighest);
  return kHandles;
}

void set_thread_stacks() {}  // 1 MiB unless the program's header says otherwise

std::uint64_t open_files(std::uint64_t most) {
  DWORD handles = 0;
  GetProcessHandleCount(GetCurrentProcess(), &handles);
  return std::min<std::uint64_t>(handles, most);
}

std::uint64_t resident_memory() {
  PROCESS_MEMORY_COUNTERS memory{};
  GetProcessMemoryInfo(GetCurrentProcess(), &memory, sizeof memory);
  return memory.WorkingSetSize;
}

void trim_heap() {}
void return_large_blocks() {}

int process_number() { return static_cast<int>(GetCurrentProcessId()); }
int open_spare_file() { return -1; }

}  // namespace racebeam
