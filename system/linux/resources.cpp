#include "system/resources.hpp"

#include <fcntl.h>
#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>
#if __has_include(<malloc.h>)
#include <malloc.h>
#endif

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <string_view>
#include <system_error>
#include <vector>

#include "system/affinity.hpp"

namespace racebeam {
namespace {

namespace fs = std::filesystem;

constexpr auto kMachine = "the machine";
constexpr auto kAffinity = "the affinity";
constexpr auto kControlGroup = "the control group";
constexpr auto kAddressSpace = "the address space (ulimit -v)";

// A directory of the cgroup hierarchy, and its version.
struct Group {
  fs::path path;
  bool unified;  // version 2
};

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream words(line);
  return {std::istream_iterator<std::string>(words), {}};
}

bool lists(std::string_view list, std::string_view name) {
  for (;;) {
    const std::size_t comma = list.find(',');
    if (list.substr(0, comma) == name) return true;
    if (comma == std::string_view::npos) return false;
    list.remove_prefix(comma + 1);
  }
}

// The path of this process's group. A line of cgroups(7) is NUMBER:CONTROLLERS:PATH; version 2 has no
// controllers.
std::optional<std::string> path_in(const std::string& root, std::string_view controller) {
  std::ifstream file(root + "/proc/self/cgroup");
  for (std::string line; std::getline(file, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    if (controller.empty() ? controllers.empty() : lists(controllers, controller))
      return line.substr(second + 1);
  }
  return std::nullopt;
}

// The directory for `path`, and those above it as far as they are mounted. A line of mountinfo (proc(5)) has
// the group at the mount's root in the 4th field, and the mount point in the 5th. After a "-" come the type,
// the source and the options.
std::vector<Group> groups_of(const std::string& root, const std::string& path, std::string_view controller) {
  std::ifstream file(root + "/proc/self/mountinfo");
  for (std::string line; std::getline(file, line);) {
    const auto words = words_of(line);
    const auto dash = std::ranges::find(words, "-");
    if (words.size() < 5 || words.end() - dash < 4) continue;
    if (dash[1] != (controller.empty() ? "cgroup2" : "cgroup")) continue;
    if (!controller.empty() && !lists(dash[3], controller)) continue;
    const fs::path mount = root + words[4], below = fs::path(path).lexically_relative(words[3]);
    const bool visible = !below.empty() && *below.begin() != "..";
    std::vector<Group> groups = {{mount, controller.empty()}};
    for (const fs::path& part : visible ? below : fs::path())
      if (part != ".") groups.push_back({groups.back().path / part, controller.empty()});
    return groups;
  }
  return {};
}

// Groups of version 1 and of version 2, since a system may have both.
std::vector<Group> all_groups(const std::string& root, std::string_view controller) {
  std::vector<Group> all;
  for (const std::string_view hierarchy : {controller, std::string_view()}) {
    const auto path = path_in(root, hierarchy);
    if (!path) continue;
    const auto groups = groups_of(root, *path, hierarchy);
    all.insert(all.end(), groups.begin(), groups.end());
  }
  return all;
}

// The numbers in a file of a group. "max" and -1 do not count: they stand for no limit.
std::vector<std::uint64_t> numbers_in(const fs::path& path) {
  std::ifstream file(path);
  std::vector<std::uint64_t> numbers;
  for (std::string word; file >> word;) {
    std::uint64_t number = 0;
    const char* const end = word.data() + word.size();
    const auto [rest, error] = std::from_chars(word.data(), end, number);
    if (error != std::errc{} || rest != end) return {};
    numbers.push_back(number);
  }
  return numbers;
}

std::optional<double> processors_of(const Group& group) {
  std::vector<std::uint64_t> quota =
      numbers_in(group.path / (group.unified ? "cpu.max" : "cpu.cfs_quota_us"));
  if (!group.unified)
    for (const std::uint64_t period : numbers_in(group.path / "cpu.cfs_period_us")) quota.push_back(period);
  if (quota.size() != 2 || quota[0] == 0 || quota[1] == 0) return std::nullopt;
  return static_cast<double>(quota[0]) / static_cast<double>(quota[1]);
}

std::optional<std::uint64_t> memory_of(const Group& group) {
  std::optional<std::uint64_t> least;
  const std::vector<const char*> names =
      group.unified ? std::vector{"memory.max", "memory.high"} : std::vector{"memory.limit_in_bytes"};
  for (const char* name : names)
    for (const std::uint64_t limit : numbers_in(group.path / name))
      least = std::min(least.value_or(limit), limit);
  return least;
}

void limit(Allowance& allowance, std::uint64_t amount, const char* by) {
  if (amount < allowance.amount) allowance = {amount, by};
}

std::uint64_t system_value(int name) { return static_cast<std::uint64_t>(std::max(1L, ::sysconf(name))); }

}  // namespace

Allowance usable_processors(const std::string& root) {
  Allowance allowance{system_value(_SC_NPROCESSORS_ONLN), kMachine};
  if (const std::size_t pinned = allowed_processors().size(); pinned > 0) limit(allowance, pinned, kAffinity);
  for (const Group& group : all_groups(root, "cpu"))
    if (const auto quota = processors_of(group))
      limit(allowance, static_cast<std::uint64_t>(std::ceil(*quota)), kControlGroup);
  return allowance;
}

Allowance usable_memory(const std::string& root) {
  Allowance allowance{system_value(_SC_PHYS_PAGES) * system_value(_SC_PAGESIZE), kMachine};
  for (const Group& group : all_groups(root, "memory"))
    if (const auto most = memory_of(group)) limit(allowance, *most, kControlGroup);
  rlimit space{};
  if (::getrlimit(RLIMIT_AS, &space) == 0) limit(allowance, space.rlim_cur, kAddressSpace);
  return allowance;
}

std::uint64_t usable_files() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return system_value(_SC_OPEN_MAX);
  const rlimit highest{limit.rlim_max, limit.rlim_max};
  return ::setrlimit(RLIMIT_NOFILE, &highest) == 0 ? highest.rlim_cur : limit.rlim_cur;
}

void set_thread_stacks() {
  constexpr std::size_t kStack = std::size_t{2} << 20;
  pthread_attr_t attributes;
  ::pthread_attr_init(&attributes);
  ::pthread_attr_setstacksize(&attributes, kStack);
  ::pthread_setattr_default_np(&attributes);
  ::pthread_attr_destroy(&attributes);
}

std::uint64_t open_files(std::uint64_t most) {
  std::uint64_t open = 0;
  for (std::uint64_t file = 0; file < most; ++file) open += ::fcntl(static_cast<int>(file), F_GETFD) != -1;
  return open;
}

std::uint64_t resident_memory() {
  std::ifstream file("/proc/self/statm");
  std::uint64_t all = 0, resident = 0;
  file >> all >> resident;
  return resident * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

void trim_heap() {
#if defined(M_TRIM_THRESHOLD)  // the GNU C library
  ::malloc_trim(0);
#endif
}

void return_large_blocks() {
#if defined(M_MMAP_THRESHOLD)  // the GNU C library
  ::mallopt(M_MMAP_THRESHOLD, 32 << 10);
#endif
}

int process_number() { return ::getpid(); }
int open_spare_file() { return ::open("/dev/null", O_RDONLY | O_CLOEXEC); }

}  // namespace racebeam
