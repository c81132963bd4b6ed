// A cartridge image on two machines, interpreted and translated. The first bytes are scheme and controller,
// size, seed, and eight steps of play of two bytes each. The rest is the image, repeated up to its size.
#include <array>
#include <memory>
#include <vector>

#include "emulator/cartridge/cartridge.hpp"
#include "emulator/console.hpp"
#include "fuzz/support/target.hpp"
#include "tests/translator/pair.hpp"

namespace racebeam::fuzz {
namespace {

constexpr std::array<std::size_t, 12> kSizes = {2048,  4096,  8192,  8448,   10496, 12288,
                                                16384, 32768, 65536, 131072, 28672, 262144};
constexpr int kSteps = 8;
constexpr std::array<Controller, 4> kLeft = {Controller::kJoystick, Controller::kKeyboard,
                                             Controller::kPaddles, Controller::kLightGun};

// A small picture, because the CPU is tested.
Properties properties_of(std::uint8_t scheme) {
  const auto names = scheme_names();
  Properties properties;
  properties.format = Format::kNtsc;
  properties.height = 100;
  properties.left = kLeft[scheme >> 6];
  const std::size_t number = scheme % 0x40U % (names.size() + 1);
  if (number > 0) properties.scheme = names[number - 1];
  return properties;
}

// size: an index of kSizes; beyond them, the image has the size of `content`.
Rom make_rom(std::uint8_t size, Bytes content) {
  Rom rom(content.begin(), content.end());
  const std::size_t length = size < kSizes.size() ? kSizes[size] : rom.size();
  if (rom.empty()) rom.resize(1);
  for (std::size_t at = 0; rom.size() < length; ++at) rom.push_back(rom[at]);
  rom.resize(std::max(length, std::size_t{1}));
  return rom;
}

struct Machine {
  Machine(const std::shared_ptr<const Rom>& rom, const Properties& properties, std::uint32_t seed,
          CpuKind cpu)
      : power_on(seed), console(rom, properties, power_on, cpu) {}

  void play(unsigned what) {
    Inputs& inputs = console.inputs();
    inputs.joystick = {static_cast<std::uint8_t>(what & 31), static_cast<std::uint8_t>(what >> 5 & 31)};
    inputs.paddle[0] = static_cast<std::int32_t>(what * 16);
    inputs.switches = static_cast<std::uint8_t>(kSwitchesAtRest & ~(what >> 10 & 3U));
    if ((what & 0x1000) != 0)
      console.set_ram(static_cast<int>(what & 127), static_cast<std::uint8_t>(what >> 4));
    if ((what & 0x6000) == 0x6000) console.reset();
    console.step((what & 0x8000) == 0);
  }

  SystemGenerator power_on;
  Console console;
};

}  // namespace

void run(Bytes input) {
  Reader reader(input);
  const Properties properties = properties_of(reader.byte());
  const std::uint8_t size = reader.byte();
  const std::uint32_t seed = reader.byte();
  Reader play(reader.take(2 * kSteps));
  const auto rom = std::make_shared<const Rom>(make_rom(size, reader.rest()));
  try {
    scheme_of(*rom, properties.scheme);
  } catch (const std::invalid_argument& refusal) {
    require(is_printable(refusal.what()) && *refusal.what() != '\0', "a refusal is a sentence",
            refusal.what());
    return;
  }
  Machine interpreted(rom, properties, seed, CpuKind::kInterpreter),
      translated(rom, properties, seed, CpuKind::kTranslator);
  for (int step = 0; step < kSteps; ++step) {
    const unsigned what = play.word();
    interpreted.play(what);
    translated.play(what);
    const std::string found = test::difference(interpreted.console, translated.console);
    require(found.empty(), "the translator does what the interpreter does", found);
  }
  // A state of a run must be accepted.
  const State state = interpreted.console.state();
  const auto ram = interpreted.console.cartridge_ram();
  translated.console.check(state, std::vector<std::uint8_t>(ram.begin(), ram.end()));
}

}  // namespace racebeam::fuzz
