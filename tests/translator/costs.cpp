// What programs cost translated, beside what they cost interpreted, from power-on, start included.
//
//   translator_costs random FIRST COUNT [STEPS]   of random programs, from seed FIRST on
//   translator_costs hostile [STEPS] [WORDS]      of the hostile ones (with these words in their name),
//                                                 undrawn and drawn
//
// Both print the distribution of the ratio and the worst. They end with 1 if a program takes more than 1.5
// times as long translated, or as many times as the variable RACEBEAM_COST_BOUND says, and 1.5 ms more. A
// machine starts with a credit of 0.75 ms (TranslationBudget), and code that was made on credit may not pay.
// They also end with 1 if a program that must gain by translation does not: nothing is translated then, and
// the ratios say nothing.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "tests/translator/cost.hpp"
#include "tests/translator/hostile.hpp"

namespace {

using namespace racebeam::test;

double bound() {
  const char* const value = std::getenv("RACEBEAM_COST_BOUND");
  return value != nullptr ? std::atof(value) : 1.5;
}

constexpr double kAllowance = 1500;  // microseconds

// What counts: the ratio of the time beyond the allowance.
double judged(const Cost& cost) { return (cost.translated - kAllowance) / cost.interpreted; }

constexpr double kSuspicious = 1.3;  // measured again, more often
constexpr int kSteps = 120, kRounds = 3, kMoreRounds = 25, kShown = 12;
constexpr int kAttempts = 8;  // other work disturbs a measurement; what costs too much does so each time

struct Result {
  std::string name;
  Cost cost;
};

class Report {
 public:
  Report(int steps, Look look) : steps_(steps), look_(look) {}

  void add(const std::string& name, const Program& program) {
    Cost cost = cost_of(program, steps_, look_, kRounds);
    if (judged(cost) > kSuspicious) cost = cost_of(program, steps_, look_, kMoreRounds);
    for (int attempt = 1; attempt < kAttempts && judged(cost) > bound(); ++attempt)
      cost = cost_of(program, steps_, look_, kMoreRounds);
    results_.push_back({name, cost});
    const Cost step = longest_step(program, std::min(steps_, 60), look_, kRounds);
    if (step.interpreted > longest_[0].cost.interpreted) longest_[0] = {name, step};
    if (step.translated > longest_[1].cost.translated) longest_[1] = {name, step};
  }

  // Returns false if the bound is exceeded.
  bool print() {
    std::ranges::sort(results_,
                      [](const Result& a, const Result& b) { return a.cost.ratio() > b.cost.ratio(); });
    double logs = 0;
    for (const Result& result : results_) logs += std::log(result.cost.ratio());
    const std::size_t count = results_.size();
    std::printf(
        "%zu programs, %d steps from power-on, %s: translated takes, of interpreted, at worst %.2f, p99 "
        "%.2f, "
        "median %.2f, geomean %.2f\n",
        count, steps_, look_ == Look::kNone ? "undrawn" : "drawn", ratio(0), ratio(count / 100),
        ratio(count / 2), std::exp(logs / static_cast<double>(count)));
    std::printf("%8s %12s %12s\n", "ratio", "interpreted", "translated");
    for (std::size_t i = 0; i < std::min<std::size_t>(kShown, count); ++i) print("", results_[i]);
    print("the longest step interpreted: ", longest_[0]);
    print("the longest step translated: ", longest_[1]);
    const auto beyond = [](const Result& result) { return judged(result.cost); };
    const Result& worst = *std::ranges::max_element(results_, {}, beyond);
    std::printf("beyond 1.5 ms, at worst %.2f  %s\n", judged(worst.cost), worst.name.c_str());
    return judged(worst.cost) <= bound();
  }

 private:
  double ratio(std::size_t rank) const { return results_[rank].cost.ratio(); }

  static void print(const char* what, const Result& result) {
    std::printf("%8.2f %9.0f us %9.0f us  %s%s\n", result.cost.ratio(), result.cost.interpreted,
                result.cost.translated, what, result.name.c_str());
  }

  int steps_;
  Look look_;
  std::vector<Result> results_;
  Result longest_[2];  // interpreted, translated
};

// Frames that count down for 12,800 cycles.
Program countdown() {
  static constexpr std::array<std::uint8_t, 20> kCode = {0xA9, 2,    0x85, 0x00, 0xA9, 0,    0x85,
                                                         0x00, 0xA0, 10,   0xA2, 0,    0xCA, 0xD0,
                                                         0xFD, 0x88, 0xD0, 0xF8, 0xF0, 0xEC};
  Program program;
  program.scheme = "4K";
  program.rom.assign(4096, 0xEA);
  std::ranges::copy(kCode, program.rom.begin());
  program.rom[0xFFC] = 0x00, program.rom[0xFFD] = 0xF0;
  return program;
}

// Whether a program that gains by translation does gain, after its code has been translated.
bool translates() {
  constexpr int kEnough = 2000;
  constexpr double kGain = 0.8;
  const double ratio = cost_of(countdown(), kEnough, Look::kNone, kRounds).ratio();
  std::printf("a loop takes %.2f of its time interpreted\n", ratio);
  return ratio < kGain;
}

bool report_random(std::uint32_t first, std::uint32_t count, int steps) {
  Report report(steps, Look::kNone);
  for (std::uint32_t seed = first; seed != first + count; ++seed) {
    const Program program = make_program(seed);
    report.add("seed " + std::to_string(seed) + " (" + std::string(program.scheme) + ")", program);
  }
  return report.print();
}

std::vector<HostileProgram> chosen(const char* words) {
  std::vector<HostileProgram> programs = hostile_programs();
  std::erase_if(programs, [words](const HostileProgram& hostile) {
    return hostile.name.find(words) == std::string::npos;
  });
  return programs;
}

bool report_hostile(int steps, const char* words) {
  bool holds = true;
  for (const Look look : {Look::kNone, Look::kEveryFrame}) {
    Report report(steps, look);
    for (const HostileProgram& hostile : chosen(words)) report.add(hostile.name, hostile.program);
    holds &= report.print();
  }
  return holds;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string_view what = argc > 1 ? argv[1] : "";
  const auto number = [&](int at, int otherwise) { return argc > at ? std::atoi(argv[at]) : otherwise; };
  const char* const words = argc > 3 ? argv[3] : "";
  if ((what == "random" || what == "hostile") && !translates()) {
    std::puts("Nothing is translated.");
    return 1;
  }
  if (what == "random" && argc > 3)
    return report_random(static_cast<std::uint32_t>(number(2, 0)), static_cast<std::uint32_t>(number(3, 0)),
                         number(4, kSteps))
               ? 0
               : 1;
  if (what == "hostile") return report_hostile(number(2, kSteps), words) ? 0 : 1;
  std::fputs("usage: translator_costs random FIRST COUNT [STEPS] | hostile [STEPS] [WORDS]\n", stderr);
  return 2;
}
