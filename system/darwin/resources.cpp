#include "system/resources.hpp"

#include <fcntl.h>
#include <limits.h>
#include <mach/mach.h>
#include <sys/resource.h>
#include <sys/sysctl.h>
#include <unistd.h>

#include <algorithm>

namespace racebeam {
namespace {

constexpr auto kMachine = "the machine";

// Returns a number that the kernel has under this name; `otherwise` if it does not have the name.
template <class Number>
Number kernel_value(const char* name, Number otherwise) {
  Number value = 0;
  std::size_t size = sizeof value;
  return ::sysctlbyname(name, &value, &size, nullptr, 0) == 0 && size == sizeof value ? value : otherwise;
}

}  // namespace

Allowance usable_processors(const std::string&) {
  return {static_cast<std::uint64_t>(std::max(1, kernel_value("hw.activecpu", 1))), kMachine};
}

// The kernel does not enforce a limit of the address space.
Allowance usable_memory(const std::string&) {
  return {kernel_value("hw.memsize", std::uint64_t{1} << 30), kMachine};
}

// The kernel refuses more files than its own limit, whatever the process may have.
std::uint64_t usable_files() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return OPEN_MAX;
  const auto most = static_cast<rlim_t>(kernel_value("kern.maxfilesperproc", OPEN_MAX));
  const rlimit highest{std::min(limit.rlim_max, most), limit.rlim_max};
  return ::setrlimit(RLIMIT_NOFILE, &highest) == 0 ? highest.rlim_cur : limit.rlim_cur;
}

void set_thread_stacks() {}  // 512 KiB; the system has no function that changes this for all threads

std::uint64_t open_files(std::uint64_t most) {
  std::uint64_t open = 0;
  for (std::uint64_t file = 0; file < most; ++file) open += ::fcntl(static_cast<int>(file), F_GETFD) != -1;
  return open;
}

void trim_heap() {}
void return_large_blocks() {}

int process_number() { return ::getpid(); }
int open_spare_file() { return ::open("/dev/null", O_RDONLY | O_CLOEXEC); }

std::uint64_t resident_memory() {
  mach_task_basic_info info{};
  mach_msg_type_number_t count = MACH_TASK_BASIC_INFO_COUNT;
  const auto data = reinterpret_cast<task_info_t>(&info);
  return ::task_info(mach_task_self(), MACH_TASK_BASIC_INFO, data, &count) == KERN_SUCCESS
             ? info.resident_size
             : 0;
}

}  // namespace racebeam
