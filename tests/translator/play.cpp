// translator_play interpreter|translator FRAMES IMAGE...: plays each image with random inputs, and prints a
// hash of the states after all steps, and how many thousand cycles were interpreted. platforms/instructions
// counts what this executes.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <random>
#include <string_view>
#include <vector>

#include "emulator/console.hpp"

namespace {

using namespace racebeam;

// FNV-1a, over words of 32 bits.
std::uint64_t add_to(std::uint64_t hash, const State& state) {
  std::uint32_t word = 0;
  const auto* bytes = reinterpret_cast<const unsigned char*>(&state);
  for (std::size_t i = 0; i + sizeof word <= sizeof state; i += sizeof word) {
    std::memcpy(&word, bytes + i, sizeof word);
    hash = (hash ^ word) * 1099511628211U;
  }
  return hash;
}

void play(const char* path, CpuKind cpu, int frames) {
  std::ifstream file(path, std::ios::binary);
  auto rom = std::make_shared<const std::vector<std::uint8_t>>(std::istreambuf_iterator<char>(file),
                                                               std::istreambuf_iterator<char>());
  SystemGenerator power_on(1);
  Properties properties;
  properties.format = Format::kNtsc;
  Console console(std::move(rom), properties, power_on, cpu);
  std::mt19937 random(1);
  std::uint64_t hash = 14695981039346656037U;
  for (int frame = 0; frame < frames; ++frame) {
    Inputs& inputs = console.inputs();
    inputs.joystick[0] = static_cast<std::uint8_t>(random() % 32);
    inputs.switches = frame % 512 < 8 ? kSwitchesAtRest & ~kSwitchReset : kSwitchesAtRest;  // starts the game
    console.step(false);
    hash = add_to(hash, console.state());
  }
  std::printf("%016llx %6lld %s\n", static_cast<unsigned long long>(hash),
              static_cast<long long>(console.interpreted_cycles() / 1000), path);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fputs("usage: translator_play interpreter|translator FRAMES IMAGE...\n", stderr);
    return 2;
  }
  const bool translates = std::string_view(argv[1]) == "translator";
  for (int i = 3; i < argc; ++i)
    play(argv[i], translates ? CpuKind::kTranslator : CpuKind::kInterpreter, std::atoi(argv[2]));
}
