#include "tests/translator/cost.hpp"

#include <time.h>

#include <algorithm>
#include <memory>

namespace racebeam::test {
namespace {

using Image = std::shared_ptr<const std::vector<std::uint8_t>>;

double microseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e6 + static_cast<double>(now.tv_nsec) * 1e-3;
}

// With a given format; otherwise each machine would run 60 frames before the first step to detect it.
Properties properties_for(const Program& program) {
  Properties properties;
  properties.format = Format::kNtsc;
  properties.ystart = 34;
  properties.height = 210;
  properties.scheme = program.scheme;
  return properties;
}

// Calls after_step after each step.
template <class Function>
void run(const Image& image, const Properties& properties, CpuKind cpu, int steps, Look look,
         Function after_step) {
  SystemGenerator power_on(1);
  Console console(image, properties, power_on, cpu);
  for (int step = 0; step < steps; ++step) {
    console.step(look == Look::kEveryFrame);
    if (look == Look::kEveryFrame) console.picture();
    after_step(step);
  }
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

constexpr CpuKind kBoth[] = {CpuKind::kInterpreter, CpuKind::kAuto};

}  // namespace

Cost cost_of(const Program& program, int steps, Look look, int rounds) {
  const auto image = std::make_shared<const std::vector<std::uint8_t>>(program.rom);
  const Properties properties = properties_for(program);
  std::vector<double> times[2];
  for (int round = 0; round < rounds; ++round) {
    for (const std::size_t which : {0U, 1U}) {
      const double start = microseconds();
      run(image, properties, kBoth[which], steps, look, [](int) {});
      times[which].push_back(microseconds() - start);
    }
  }
  return {median(times[0]), median(times[1])};
}

void play(const Program& program, int steps, Look look, CpuKind cpu) {
  run(std::make_shared<const std::vector<std::uint8_t>>(program.rom), properties_for(program), cpu, steps,
      look, [](int) {});
}

Cost longest_step(const Program& program, int steps, Look look, int rounds) {
  const auto image = std::make_shared<const std::vector<std::uint8_t>>(program.rom);
  const Properties properties = properties_for(program);
  std::vector<double> shortest[2];
  for (auto& times : shortest) times.assign(static_cast<std::size_t>(steps), 1e12);
  for (int round = 0; round < rounds; ++round) {
    for (const std::size_t which : {0U, 1U}) {
      double before = microseconds();
      run(image, properties, kBoth[which], steps, look, [&](int step) {
        const double now = microseconds();
        double& best = shortest[which][static_cast<std::size_t>(step)];
        if (step > 0)
          best = std::min(best, now - before);  // the first one includes the construction of the machine
        else
          best = 0;
        before = now;
      });
    }
  }
  return {*std::ranges::max_element(shortest[0]), *std::ranges::max_element(shortest[1])};
}

}  // namespace racebeam::test
