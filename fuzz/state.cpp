// The bytes of a state. The first byte selects a machine, or says that the rest are the bytes themselves.
// Otherwise the rest alters a state of that machine, four bytes at a time: offset (low byte first),
// operation, value.
#include <zlib.h>

#include <cstring>
#include <vector>

#include "environment/saved/saved_state_format.hpp"
#include "environment/saved_state.hpp"
#include "fuzz/support/keep_code.hpp"
#include "fuzz/support/target.hpp"
#include "games/catalogue.hpp"
#include "system/printable.hpp"
#include "tests/support/random_image.hpp"

namespace racebeam::fuzz {
namespace {

using State = std::vector<std::uint8_t>;

constexpr std::uint8_t kWhole = 0xFF;
constexpr std::size_t kHeader = 24, kChecksum = 20;  // saved_state_format.cpp
constexpr int kActs = 3;

// Detecting the format would take a second of frames.
std::shared_ptr<const Game> random_game(std::string_view scheme) {
  Game game = *test::random_game(scheme);
  game.images.front().properties.format = Format::kNtsc;
  return std::make_shared<const Game>(std::move(game));
}

std::vector<Cartridge> make_cartridges() {
  std::vector<Cartridge> all;
  for (const char* where : {"builtin:beamfall", "builtin:updraft"}) {
    const auto image = load_image(where);
    all.push_back({image, recognise(*image).game});
  }
  for (const std::string_view scheme : test::random_schemes())
    all.push_back({test::random_image(scheme, 3), random_game(scheme)});
  for (const Cartridge& cartridge : all) keep_code(cartridge);
  return all;
}

Environment make_machine(const Cartridge& cartridge, CpuKind cpu) {
  Settings settings;
  settings.random_seed = 1;
  settings.sound = true;
  settings.color_averaging = true;
  settings.cpu = cpu;
  return {cartridge.image, cartridge.game, settings};
}

void set_checksum(State& state) {
  if (state.size() < kHeader) return;
  const auto sum =
      static_cast<std::uint32_t>(crc32(0, state.data() + kHeader, static_cast<uInt>(state.size() - kHeader)));
  std::memcpy(state.data() + kChecksum, &sum, sizeof sum);
}

// Any bytes are valid in pictures, so offsets are before or after them.
std::size_t place_in(const State& state, const Environment& machine, std::size_t number) {
  const std::size_t pictures = 2U * static_cast<std::size_t>(machine.height()) * kScreenWidth;
  const std::size_t generator = (MersenneTwister::kWords + 1) * sizeof(std::uint32_t);
  const std::size_t place = number % (state.size() - pictures);
  return place < state.size() - pictures - generator ? place : place + pictures;
}

State altered(State state, const Environment& machine, Reader& changes) {
  while (!changes.empty()) {
    std::uint8_t& byte = state[place_in(state, machine, changes.word())];
    const std::uint8_t operation = changes.byte(), value = changes.byte();
    switch (operation % 4) {
      case 0: byte = value; break;
      case 1: byte = static_cast<std::uint8_t>(byte ^ value); break;
      case 2: byte = static_cast<std::uint8_t>(byte + value); break;
      default: state.resize(state.size() - value % 16U); return state;
    }
  }
  return state;
}

// The state after some acts.
State play(Environment& machine, const Environment::Saved& from) {
  machine.restore(from);
  const auto& legal = machine.game().legal_actions;
  for (std::size_t act = 0; act < kActs && !machine.game_over(); ++act)
    machine.act(legal[act * 7 % legal.size()]);
  return to_bytes(*machine.save(true), machine);
}

}  // namespace

void run(Bytes input) {
  static const std::vector<Cartridge> cartridges = make_cartridges();
  Reader reader(input);
  const std::uint8_t which = reader.byte();
  const Cartridge& cartridge = cartridges[which == kWhole ? 0 : which % cartridges.size()];
  Environment interpreted = make_machine(cartridge, CpuKind::kInterpreter);

  State state;
  if (which == kWhole)
    state.assign(reader.rest().begin(), reader.rest().end());
  else
    state = altered(to_bytes(*interpreted.save(true), interpreted), interpreted, reader);
  set_checksum(state);

  std::shared_ptr<const Environment::Saved> saved;
  try {
    saved = from_bytes(state, interpreted);
  } catch (const std::invalid_argument& refusal) {
    require(printable(refusal.what()) == refusal.what() && *refusal.what() != '\0', "a refusal is a sentence",
            refusal.what());
    return;
  }
  require(to_bytes(*saved, interpreted) == state, "a state that was accepted is written as it was read");
  Environment translated = make_machine(cartridge, CpuKind::kAuto);
  const State end = play(interpreted, *saved);
  require(end == play(translated, *saved), "a state leads to the same, interpreted and translated");
  try {
    from_bytes(end, interpreted);
  } catch (const std::invalid_argument& refusal) {
    require(false, "what an accepted state leads to is accepted", refusal.what());
  }
}

}  // namespace racebeam::fuzz
