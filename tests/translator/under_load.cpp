// Whether games are translated while other processes use the processors.
//
//   translator_under_load RUNS LOAD IMAGE...
//
// LOAD processes burn the processors, and yield. Meanwhile each image is run RUNS times from power-on. A run
// counts as interpreted if the interpreter executes much more of its second half than where translation has
// no budget. Ends with 1 if a run was.
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "emulator/base/stopwatch.hpp"
#include "emulator/console.hpp"

namespace {

using namespace racebeam;
using Image = std::shared_ptr<const std::vector<std::uint8_t>>;

constexpr int kHalf = 3000;                // frames
constexpr int kCyclesPerFrame = 262 * 76;  // of NTSC
constexpr int kSkipped = 77;
constexpr double kMuch = 0.1;

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

// The part of the cycles that the interpreter executes in the second half of a run.
double interpreted_part(const Image& image, CpuKind cpu) {
  SystemGenerator power_on(1);
  Console console(image, {}, power_on, cpu);
  for (int frame = 0; frame < kHalf; ++frame) console.step();
  const std::int64_t before = console.interpreted_cycles();
  for (int frame = 0; frame < kHalf; ++frame) console.step();
  return static_cast<double>(console.interpreted_cycles() - before) / (kHalf * kCyclesPerFrame);
}

// Returns whether no run was interpreted.
bool report(const std::string& path, int runs) {
  std::ifstream file(path, std::ios::binary);
  const auto image = std::make_shared<const std::vector<std::uint8_t>>(std::istreambuf_iterator<char>(file),
                                                                       std::istreambuf_iterator<char>());
  const double translated = interpreted_part(image, CpuKind::kTranslator);
  int interpreted = 0;
  double most = 0;
  for (int run = 0; run < runs; ++run) {
    const double part = interpreted_part(image, CpuKind::kAuto);
    interpreted += part > translated + kMuch ? 1 : 0;
    most = std::max(most, part);
  }
  std::printf(
      "%s: the interpreter executes %.1f %% without a budget, at most %.1f %% with it; %d of %d runs were "
      "interpreted\n",
      path.c_str(), 100 * translated, 100 * most, interpreted, runs);
  return interpreted == 0;
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
