#include "tests/translator/pair.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <random>
#include <sstream>

#include "emulator/console.hpp"
#include "tests/translator/random_program.hpp"

namespace racebeam::test {
namespace {

// A small picture, because the CPU is tested.
Properties properties_for(const Program& program) {
  Properties properties;
  properties.format = Format::kNtsc;
  properties.ystart = 34;
  properties.height = 24;
  properties.scheme = program.scheme;
  return properties;
}

struct Machine {
  Machine(std::shared_ptr<const std::vector<std::uint8_t>> rom, const Properties& properties,
          std::uint32_t seed, CpuKind cpu)
      : power_on(seed), console(std::move(rom), properties, power_on, cpu) {}

  SystemGenerator power_on;
  Console console;
};

template <class Range>
std::string first_difference(const char* what, const Range& a, const Range& b) {
  if (std::equal(a.begin(), a.end(), b.begin(), b.end())) return {};  // compares many bytes at a time
  const auto [at, other] = std::mismatch(a.begin(), a.end(), b.begin());
  std::ostringstream text;
  text << what << ", byte " << at - a.begin() << ": " << int{*at} << " interpreted, " << int{*other}
       << " translated";
  return text.str();
}

std::array<std::uint8_t, kSamplesPerBlock> samples_of(Console& console) {
  std::array<std::uint8_t, kSamplesPerBlock> samples{};
  console.sound().generate(samples);
  return samples;
}

}  // namespace

std::string difference(Console& interpreted, Console& translated) {
  using StateBytes = std::array<std::uint8_t, sizeof(State)>;
  const auto bytes = [](const Console& console) {
    StateBytes all;
    std::memcpy(all.data(), &console.state(), sizeof all);
    return all;
  };
  std::string found = first_difference("state", bytes(interpreted), bytes(translated));
  if (found.empty())
    found = first_difference("cartridge RAM", interpreted.cartridge_ram(), translated.cartridge_ram());
  if (found.empty()) found = first_difference("picture", interpreted.picture(), translated.picture());
  if (found.empty())
    found =
        first_difference("previous picture", interpreted.previous_picture(), translated.previous_picture());
  if (found.empty()) found = first_difference("sound", samples_of(interpreted), samples_of(translated));
  return found;
}

std::string difference_in_program(std::uint32_t seed, int steps, CpuKind cpu) {
  Program program = make_program(seed);
  const Properties properties = properties_for(program);
  const auto rom = std::make_shared<const std::vector<std::uint8_t>>(std::move(program.rom));
  Machine interpreted(rom, properties, seed, CpuKind::kInterpreter), translated(rom, properties, seed, cpu);
  Console* both[] = {&interpreted.console, &translated.console};
  std::mt19937 random(seed);
  for (int step = 0; step < steps; ++step) {
    const auto index = static_cast<int>(random() % 128);
    const auto value = static_cast<std::uint8_t>(random());
    for (Console* console : both) {
      if (step > 0) console->set_ram(index, value);
      console->step();
    }
    const std::string found = difference(*both[0], *both[1]);
    if (found.empty()) continue;
    return "seed " + std::to_string(seed) + " (" + std::string(program.scheme) + "), step " +
           std::to_string(step) + ": " + found;
  }
  return {};
}

}  // namespace racebeam::test
