// Whether games are translated while other processes use the processors.
//
//   translator_under_load RUNS LOAD IMAGE...
//
// LOAD processes burn the processors, and yield. Meanwhile each image is run RUNS times from power-on. A run
// is divided into parts of some frames, and the fastest part of its second half counts, since other work
// lengthens processor time, too. If that is nearer to what the interpreter takes than to what the translator
// takes, the run counts as interpreted. Ends with 1 if a run was.
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "emulator/base/stopwatch.hpp"
#include "emulator/console.hpp"

namespace {

using namespace racebeam;
using Image = std::shared_ptr<const std::vector<std::uint8_t>>;

constexpr int kParts = 60, kPart = 100;  // frames
constexpr int kSkipped = 77;
constexpr int kTries = 3;  // of the interpreter and of the translator

// Processes that use a processor for a while, and yield. They end with this object, or with this process.
class Load {
 public:
  explicit Load(int processes) {
    for (int number = 0; number < processes; ++number) {
      const pid_t child = fork();
      if (child == 0) burn(static_cast<unsigned>(number));
      if (child > 0) children_.push_back(child);
    }
  }
  Load(const Load&) = delete;
  Load& operator=(const Load&) = delete;
  ~Load() {
    for (const pid_t child : children_) kill(child, SIGKILL);
    for (const pid_t child : children_) waitpid(child, nullptr, 0);
  }

 private:
  [[noreturn]] static void burn(unsigned seed) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    for (;;) {
      seed = seed * 1664525 + 1013904223;
      const std::int64_t end = host_clocks().wall() + 1000 * (1LL << (seed >> 24) % 14);  // 1 us to 8 ms
      while (host_clocks().wall() < end) {
      }
      sched_yield();
    }
  }

  std::vector<pid_t> children_;
};

// The fastest part of the second half of a run, in nanoseconds.
std::int64_t fastest_part(const Image& image, CpuKind cpu) {
  SystemGenerator power_on(1);
  Console console(image, {}, power_on, cpu);
  std::int64_t fastest = std::numeric_limits<std::int64_t>::max();
  for (int part = 0; part < kParts; ++part) {
    const Stopwatch watch;
    for (int frame = 0; frame < kPart; ++frame) console.step();
    if (part >= kParts / 2) fastest = std::min(fastest, watch.elapsed());
  }
  return fastest;
}

std::int64_t best_of_tries(const Image& image, CpuKind cpu) {
  std::int64_t best = fastest_part(image, cpu);
  for (int again = 1; again < kTries; ++again) best = std::min(best, fastest_part(image, cpu));
  return best;
}

// Returns whether no run was interpreted.
bool report(const std::string& path, int runs) {
  std::ifstream file(path, std::ios::binary);
  const auto image = std::make_shared<const std::vector<std::uint8_t>>(std::istreambuf_iterator<char>(file),
                                                                       std::istreambuf_iterator<char>());
  const std::int64_t interpreted = best_of_tries(image, CpuKind::kInterpreter);
  const std::int64_t translated = best_of_tries(image, CpuKind::kTranslator);
  const double bound = std::sqrt(static_cast<double>(interpreted) * static_cast<double>(translated));
  int slow = 0;
  for (int run = 0; run < runs; ++run)
    slow += static_cast<double>(fastest_part(image, CpuKind::kAuto)) > bound ? 1 : 0;
  std::printf("%s: a frame takes %.1f us interpreted, %.1f us translated; %d of %d runs were interpreted\n",
              path.c_str(), static_cast<double>(interpreted) / kPart / 1000,
              static_cast<double>(translated) / kPart / 1000, slow, runs);
  return slow == 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fputs("usage: translator_under_load RUNS LOAD IMAGE...\n", stderr);
    return 2;
  }
  if (*Translator::obstacle() != '\0') {
    std::printf("not checked: code cannot be translated: %s\n", Translator::obstacle());
    return kSkipped;
  }
  const Load load(std::atoi(argv[2]));
  bool holds = true;
  for (int at = 3; at < argc; ++at) holds &= report(argv[at], std::atoi(argv[1]));
  return holds ? 0 : 1;
}
