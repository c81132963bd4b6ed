#include "system/resources.hpp"

#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>

namespace fs = std::filesystem;
using namespace racebeam;

namespace {

constexpr auto kControlGroup = "the control group";
constexpr auto kUnified = "25 1 0:22 / /sys/fs/cgroup rw,nosuid shared:9 - cgroup2 cgroup2 rw\n";
constexpr auto kVersion1 =
    "31 1 0:28 / /sys/fs/cgroup rw - tmpfs tmpfs rw,mode=755\n"
    "32 31 0:29 / /sys/fs/cgroup/cpu,cpuacct rw - cgroup cgroup rw,cpu,cpuacct\n"
    "35 31 0:32 / /sys/fs/cgroup/memory rw - cgroup cgroup rw,memory\n";

// The files of a simulated system, in a folder.
class Root {
 public:
  ~Root() { fs::remove_all(path_); }
  Root() = default;
  Root(const Root&) = delete;
  Root& operator=(const Root&) = delete;

  void write(const std::string& name, const std::string& text) const {
    const fs::path file = path_ / name;
    fs::create_directories(file.parent_path());
    std::ofstream(file) << text;
  }
  void set_up(const std::string& groups, const std::string& mounts) const {
    write("proc/self/cgroup", groups);
    write("proc/self/mountinfo", mounts);
  }
  std::uint64_t memory() const { return usable_memory(path_).amount; }
  std::uint64_t processors() const { return usable_processors(path_).amount; }
  std::string path() const { return path_; }

 private:
  fs::path path_ = fs::temp_directory_path() / ("resources-" + std::to_string(::getpid()));
};

}  // namespace

TEST_CASE("without control groups it is the machine's memory") {
  const Root root;
  const Allowance all = usable_memory(root.path());
  CHECK(all.limited_by == "the machine");
  CHECK(all.amount == static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES) * ::sysconf(_SC_PAGESIZE)));
}

#if !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)  // they need much address space themselves
TEST_CASE("a limit of the address space counts") {
  rlimit before{};
  REQUIRE(::getrlimit(RLIMIT_AS, &before) == 0);
  const rlimit most{std::uint64_t{3} << 30, before.rlim_max};
  REQUIRE(::setrlimit(RLIMIT_AS, &most) == 0);
  const Allowance all = usable_memory("/nowhere");
  REQUIRE(::setrlimit(RLIMIT_AS, &before) == 0);
  CHECK(all.amount == most.rlim_cur);
  CHECK(all.limited_by == "the address space (ulimit -v)");
}
#endif

TEST_CASE("the smallest limit of the path counts, in version 2") {
  const Root root;
  root.set_up("0::/user/job/step\n", kUnified);
  const std::string top = "sys/fs/cgroup/";
  root.write(top + "user/memory.max", "max\n");
  root.write(top + "user/job/memory.max", "5000000\n");
  root.write(top + "user/job/step/memory.max", "6000000\n");
  CHECK(root.memory() == 5000000);
  CHECK(usable_memory(root.path()).limited_by == kControlGroup);
  root.write(top + "user/memory.high", "4000000\n");
  CHECK(root.memory() == 4000000);
  root.write(top + "other/memory.max", "1\n");
  CHECK(root.memory() == 4000000);
  root.write(top + "user/job/cpu.max", "50000 100000\n");
  CHECK(root.processors() == 1);
  CHECK(
      usable_processors(root.path()).limited_by ==
      (usable_processors("/nowhere").amount == 1 ? usable_processors("/nowhere").limited_by : kControlGroup));
}

TEST_CASE("the smallest limit of the path counts, in version 1") {
  const Root root;
  root.set_up("5:memory:/docker/job\n4:cpu,cpuacct:/docker/job\n1:name=systemd:/docker\n0::/\n", kVersion1);
  const std::string memory = "sys/fs/cgroup/memory/", cpu = "sys/fs/cgroup/cpu,cpuacct/";
  root.write(memory + "docker/job/memory.limit_in_bytes", "9223372036854771712\n");
  CHECK(usable_memory(root.path()).limited_by == "the machine");
  root.write(memory + "docker/memory.limit_in_bytes", "7000000\n");
  CHECK(root.memory() == 7000000);
  root.write(cpu + "docker/job/cpu.cfs_quota_us", "-1\n");
  root.write(cpu + "docker/job/cpu.cfs_period_us", "100000\n");
  CHECK(root.processors() == usable_processors("/nowhere").amount);
  root.write(cpu + "docker/cpu.cfs_quota_us", "100000\n");
  root.write(cpu + "docker/cpu.cfs_period_us", "100000\n");
  CHECK(root.processors() == 1);
}

TEST_CASE("a system may have groups of both versions") {
  const Root root;
  root.set_up("5:memory:/job\n0::/job\n",
              std::string(kVersion1) + "36 31 0:33 / /sys/fs/cgroup/unified rw - cgroup2 cgroup2 rw\n");
  root.write("sys/fs/cgroup/memory/job/memory.limit_in_bytes", "7000000\n");
  root.write("sys/fs/cgroup/unified/job/memory.max", "8000000\n");
  CHECK(root.memory() == 7000000);
  root.write("sys/fs/cgroup/unified/job/memory.high", "6000000\n");
  CHECK(root.memory() == 6000000);
}

TEST_CASE("a controller is known by its whole name") {
  const Root root;
  root.set_up("3:cpuset:/other\n4:cpuacct,cpu:/job\n",
              "31 1 0:28 / /sys/set rw - cgroup cgroup rw,cpuset\n"
              "32 1 0:29 / /sys/cpu rw - cgroup cgroup rw,cpuacct,cpu\n");
  for (const std::string folder : {"sys/set/other/", "sys/set/job/", "sys/cpu/other/"}) {
    root.write(folder + "cpu.cfs_quota_us", "1\n");
    root.write(folder + "cpu.cfs_period_us", "1\n");
  }
  const std::uint64_t all = usable_processors("/nowhere").amount;
  CHECK(root.processors() == all);
  root.write("sys/cpu/job/cpu.cfs_quota_us", "100000\n");
  root.write("sys/cpu/job/cpu.cfs_period_us", "100000\n");
  CHECK(root.processors() == 1);
}

TEST_CASE("a quota without a period, or one of zero, does not limit anything") {
  const Root root;
  root.set_up("0::/job\n", kUnified);
  for (const char* const quota : {"50000\n", "0 100000\n", "50000 0\n", "1 2 3\n"}) {
    root.write("sys/fs/cgroup/job/cpu.max", quota);
    CHECK(root.processors() == usable_processors("/nowhere").amount);
  }
}

TEST_CASE("a quota is rounded up to whole processors") {
  const Root root;
  root.set_up("0::/job\n", kUnified);
  const std::uint64_t all = usable_processors("/nowhere").amount;
  for (const auto& [quota, expected] :
       {std::pair("1 100000", 1), {"100000 100000", 1}, {"100001 100000", 2}, {"max 100000", 9999}}) {
    root.write("sys/fs/cgroup/job/cpu.max", quota);
    CHECK(root.processors() == std::min<std::uint64_t>(all, static_cast<std::uint64_t>(expected)));
  }
}

TEST_CASE("in a container the mount begins at the container's group") {
  const Root root;
  root.set_up("0::/docker/abc/job\n", "25 1 0:22 /docker/abc /sys/fs/cgroup rw - cgroup2 cgroup2 rw\n");
  root.write("sys/fs/cgroup/memory.max", "3000000\n");
  CHECK(root.memory() == 3000000);
  root.write("sys/fs/cgroup/job/memory.max", "2000000\n");
  CHECK(root.memory() == 2000000);
  root.set_up("0::/../elsewhere\n", kUnified);  // a group outside of what the namespace shows
  CHECK(root.memory() == 3000000);
}

TEST_CASE("invalid files set no limits") {
  const Root root;
  root.set_up("nonsense\n0:\n0::/job\n", std::string("\n1 2 3\na b c d e -\n") + kUnified);
  for (const char* text : {"", "-5", "many", "12x", "99999999999999999999999"}) {
    root.write("sys/fs/cgroup/job/memory.max", text);
    root.write("sys/fs/cgroup/job/cpu.max", text);
    CHECK(usable_memory(root.path()).limited_by == "the machine");
    CHECK(root.processors() == usable_processors("/nowhere").amount);
  }
}

TEST_CASE("processors that the process is not allowed to run on do not count") {
  cpu_set_t before, one;
  REQUIRE(::sched_getaffinity(0, sizeof before, &before) == 0);
  CPU_ZERO(&one);
  for (int processor = 0; processor < CPU_SETSIZE; ++processor) {
    if (CPU_ISSET(processor, &before)) {
      CPU_SET(processor, &one);
      break;
    }
  }
  REQUIRE(::sched_setaffinity(0, sizeof one, &one) == 0);
  CHECK(usable_processors("/nowhere").amount == 1);
  REQUIRE(::sched_setaffinity(0, sizeof before, &before) == 0);
  CHECK(usable_processors("/nowhere").amount == static_cast<std::uint64_t>(CPU_COUNT(&before)));
}

TEST_CASE("the process may open as many files as the hard limit says") {
  rlimit before{};
  REQUIRE(::getrlimit(RLIMIT_NOFILE, &before) == 0);
  const rlimit few{before.rlim_max < 100 ? before.rlim_max : 100, before.rlim_max};
  REQUIRE(::setrlimit(RLIMIT_NOFILE, &few) == 0);
  CHECK(usable_files() == before.rlim_max);
  rlimit now{};
  REQUIRE(::getrlimit(RLIMIT_NOFILE, &now) == 0);
  CHECK(now.rlim_cur == before.rlim_max);
  REQUIRE(::setrlimit(RLIMIT_NOFILE, &before) == 0);
}

TEST_CASE("open files are counted below a number") {
  const std::uint64_t before = open_files(1000);
  const int file = open_spare_file();
  REQUIRE(file >= 0);
  CHECK(open_files(1000) == before + 1);
  CHECK(open_files(static_cast<std::uint64_t>(file) + 1) == open_files(static_cast<std::uint64_t>(file)) + 1);
  ::close(file);
  CHECK(open_files(1000) == before);
  CHECK(open_files(0) == 0);
}

TEST_CASE("memory is resident once it is used") {
  constexpr std::uint64_t kSize = std::uint64_t{32} << 20;
  const std::uint64_t before = resident_memory();
  const auto memory = std::make_unique_for_overwrite<char[]>(kSize);
  CHECK(resident_memory() < before + kSize / 2);
  std::memset(memory.get(), 'x', kSize);
  CHECK(memory[kSize / 3] == 'x');
  const std::uint64_t more = resident_memory() - before;
  CHECK((more > kSize / 2 && more < 2 * kSize));
}

#if defined(__GLIBC__)
TEST_CASE("threads that start have stacks of two MiB") {
  pthread_attr_t before, now;
  REQUIRE(::pthread_getattr_default_np(&before) == 0);
  set_thread_stacks();
  REQUIRE(::pthread_getattr_default_np(&now) == 0);
  std::size_t size = 0;
  REQUIRE(::pthread_attr_getstacksize(&now, &size) == 0);
  CHECK(size == std::size_t{2} << 20);
  REQUIRE(::pthread_setattr_default_np(&before) == 0);
  for (pthread_attr_t* const attributes : {&before, &now}) ::pthread_attr_destroy(attributes);
}
#endif
