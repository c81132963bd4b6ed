// States from an untrusted source. Bytes with a right checksum and wrong values are either refused with a
// sentence, or do no harm: what can be restored runs, with the same result interpreted and translated. The
// test is most useful under the sanitizers (preset `address`). RACEBEAM_FUZZ is the number of alterations of
// each image, and RACEBEAM_FUZZ_SEED the first seed. A failure prints the seed of its alteration.
#include <zlib.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <cstring>

#include "environment/saved/saved_state_format.hpp"
#include "environment/saved_state.hpp"
#include "tests/support/counter_image.hpp"
#include "tests/support/needed_rom.hpp"
#include "tests/support/random_image.hpp"

namespace racebeam {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr int kFrames = 300;
constexpr std::size_t kHeaderSize = 24, kChecksumAt = 20;

unsigned number_from(const char* variable, unsigned otherwise) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != '\0' ? static_cast<unsigned>(std::strtoul(value, nullptr, 10))
                                            : otherwise;
}

void set_checksum(Bytes& bytes) {
  const auto sum = static_cast<std::uint32_t>(
      crc32(0, bytes.data() + kHeaderSize, static_cast<uInt>(bytes.size() - kHeaderSize)));
  std::memcpy(bytes.data() + kChecksumAt, &sum, sizeof sum);
}

// A position in a state: mostly in the machine's values, which are few compared with the pixels.
std::size_t place(std::mt19937& random, std::size_t size) {
  constexpr std::size_t kMachine = kHeaderSize + sizeof(Identity) + 12, kValues = kMachine + sizeof(State);
  const auto between = [&](std::size_t first, std::size_t end) { return first + random() % (end - first); };
  switch (random() % 16) {
    case 0: return between(kHeaderSize, kMachine);
    case 1: return between(size - sizeof(std::mt19937) / 2, size);
    case 2: return between(kHeaderSize, size);
    case 3:
    case 4:
    case 5: return between(kValues, kMachine + sizeof(Environment::Saved::Values));
    default: return between(kMachine, kValues);
  }
}

void alter_once(Bytes& bytes, std::mt19937& random) {
  constexpr std::uint32_t kTelling[] = {0,   1,   0x7FFFFFFF, 0x80000000, 0xFFFFFFFF,
                                        160, 228, 0x1FFFFFFF, 0x7FC00000};
  const std::size_t at = place(random, bytes.size());
  switch (random() % 4) {
    case 0: bytes[at] ^= static_cast<std::uint8_t>(1U << random() % 8); return;
    case 1: bytes[at] = static_cast<std::uint8_t>(random()); return;
    case 2: bytes[at] = static_cast<std::uint8_t>(bytes[at] + (random() % 2 != 0 ? 1 : -1)); return;
    default: break;
  }
  const std::uint32_t word = kTelling[random() % std::size(kTelling)];
  const std::size_t aligned = std::min(at & ~std::size_t{3}, bytes.size() - sizeof word);
  std::memcpy(bytes.data() + aligned, &word, sizeof word);
}

void alter(Bytes& bytes, std::mt19937& random) {
  for (auto n = 1 + random() % 3; n > 0; --n) alter_once(bytes, random);
  set_checksum(bytes);
}

// One machine interprets, the other translates if possible; all else is equal.
struct Pair {
  Pair(const std::shared_ptr<const Image>& image, const std::shared_ptr<const Game>& game)
      : interpreted(image, game, settings(CpuKind::kInterpreter)),
        translated(image, game, settings(CpuKind::kAuto)) {}

  Environment interpreted, translated;

 private:
  static Settings settings(CpuKind cpu) {
    Settings settings;
    settings.sound = true;
    settings.color_averaging = true;
    settings.cpu = cpu;
    return settings;
  }
};

void play(Environment& environment, int frames, std::mt19937& random) {
  const auto& legal = environment.game().legal_actions;
  for (int i = 0; i < frames; ++i) {
    environment.act(legal[random() % legal.size()]);
    if (environment.game_over() || random() % 256 == 0) environment.reset_game();
  }
}

// A reset that cannot reach the game's mode throws, as with an unsuitable image. Returns the final state.
Bytes play_nonsense(Environment& environment, const Environment::Saved& from, std::mt19937 random) {
  std::vector<std::uint8_t> rgb;
  environment.restore(from);
  try {
    play(environment, kFrames, random);
  } catch (const std::invalid_argument&) {
  }
  environment.screen_rgb(rgb);
  return to_bytes(*environment.save(true), environment);
}

struct Counts {
  unsigned refused = 0, played = 0;
};

// An accepted state leads to accepted states, and to the same one with either CPU.
void try_bytes(const Bytes& bytes, Pair& pair, const std::mt19937& random, Counts& counts) {
  std::shared_ptr<const Environment::Saved> saved;
  try {
    saved = from_bytes(bytes, pair.interpreted);
  } catch (const std::invalid_argument& refusal) {
    REQUIRE(std::string(refusal.what()).size() > 10);
    ++counts.refused;
    return;
  }
  const Bytes later = play_nonsense(pair.interpreted, *saved, random);
  const bool same = later == play_nonsense(pair.translated, *saved, random);
  REQUIRE(same);
  REQUIRE_NOTHROW(from_bytes(later, pair.interpreted));
  ++counts.played;
}

Counts alter_states_of(const std::shared_ptr<const Image>& image, const std::shared_ptr<const Game>& game,
                       unsigned count) {
  Pair pair(image, game);
  const auto start = pair.interpreted.save(true);
  const unsigned first = number_from("RACEBEAM_FUZZ_SEED", 1);
  Counts counts;
  Bytes sound;
  for (unsigned i = 0; i < count; ++i) {
    INFO(game->name << " " << image->md5 << " " << game->properties_for(image->md5).scheme
                    << ", alteration with seed " << first + i);
    std::mt19937 random(first + i);
    if (i % 16 == 0) sound = play_nonsense(pair.interpreted, *start, random);
    Bytes altered = sound;
    alter(altered, random);
    try_bytes(altered, pair, random, counts);
  }
  return counts;
}

TEST_CASE("Altered states of random programs in every scheme are refused or do no harm") {
  const unsigned count = number_from("RACEBEAM_FUZZ", 25);
  Counts all;
  for (const std::string_view scheme : test::random_schemes()) {
    const Counts counts = alter_states_of(test::random_image(scheme, 3), test::random_game(scheme), count);
    all.refused += counts.refused;
    all.played += counts.played;
  }
  CHECK(all.refused > 0);
  CHECK(all.played > 0);
}

// Sticks and paddles, F8, E0, FE, on-board RAM, DPC, PAL, a mode program.
TEST_CASE("Altered states of games are refused or do no harm") {
  const unsigned count = number_from("RACEBEAM_FUZZ", 25);
  CHECK(alter_states_of(load_image("builtin:beamfall"), find_game("beamfall"), count).played > 0);
  for (const char* name :
       {"breakout", "seaquest", "montezuma_revenge", "robotank", "elevator_action", "skiing", "pitfall2"}) {
    const auto image = test::needed_rom_of(name);
    if (image) CHECK(alter_states_of(image, find_game(name), count).played > 0);
  }
}

}  // namespace
}  // namespace racebeam
