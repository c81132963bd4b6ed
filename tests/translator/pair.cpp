#include "tests/translator/pair.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <optional>
#include <random>
#include <sstream>
#include <vector>

#include "emulator/console.hpp"

namespace racebeam::test {
namespace {

// A small picture, because the CPU is tested. Of eight programs, five have paddles, one of them at both
// ports.
Properties properties_for(const Program& program, std::uint32_t seed) {
  Properties properties;
  properties.format = Format::kNtsc;
  properties.ystart = 34;
  properties.height = 24;
  properties.scheme = program.scheme;
  if (seed % 4 == 1 || seed % 8 == 2) properties.left = Controller::kPaddles;
  if (seed % 4 == 3 || seed % 8 == 2) properties.right = Controller::kPaddles;
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

// A capacitor is charged at once, within a few lines or within the frame.
Inputs make_inputs(std::mt19937& random) {
  constexpr std::array<std::uint32_t, 3> kMaxOhms = {1, 50'000, 1'000'000};
  Inputs inputs;
  for (std::int32_t& ohms : inputs.paddle) {
    const std::uint32_t most = kMaxOhms[random() % kMaxOhms.size()];
    ohms = static_cast<std::int32_t>(random() % most);
  }
  for (std::uint8_t& stick : inputs.joystick) stick = static_cast<std::uint8_t>(random() % 32);
  inputs.paddle_fire = static_cast<std::uint8_t>(random() % 16);
  return inputs;
}

// A moment that machines can return to.
struct Moment {
  explicit Moment(const Console& console)
      : state(console.state()),
        cartridge_ram(console.cartridge_ram().begin(), console.cartridge_ram().end()),
        pictures(console.pictures()) {}

  void restore(Console& console) const {
    console.restore(state, cartridge_ram);
    console.restore_pictures(pictures);
  }

  State state;
  std::vector<std::uint8_t> cartridge_ram;
  FrameBuffers pictures;
};

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

std::string difference_in_program(std::uint32_t seed, int steps, CpuKind cpu,
                                  Program (*make)(std::uint32_t)) {
  Program program = make(seed);
  const Properties properties = properties_for(program, seed);
  const auto rom = std::make_shared<const std::vector<std::uint8_t>>(std::move(program.rom));
  Machine interpreted(rom, properties, seed, CpuKind::kInterpreter), translated(rom, properties, seed, cpu);
  Console* both[] = {&interpreted.console, &translated.console};
  std::mt19937 random(seed);
  std::optional<Moment> saved;
  for (int step = 0; step < steps; ++step) {
    const auto index = static_cast<int>(random() % 128);
    const auto value = static_cast<std::uint8_t>(random());
    const Inputs inputs = make_inputs(random);
    const bool returns = saved && random() % 4 == 0;
    if (random() % 4 == 0) saved.emplace(*both[random() % 2]);
    for (Console* console : both) {
      if (returns) saved->restore(*console);
      if (step > 0) console->set_ram(index, value);
      console->inputs() = inputs;
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
