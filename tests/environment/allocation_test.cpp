// What machines allocate while they run, and what they take. All of this program's allocations are counted,
// so it has no other tests.
#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <new>
#include <random>
#include <set>

#include "emulator/base/large_pages.hpp"
#include "emulator/console.hpp"
#include "emulator/translator/translator.hpp"
#include "environment/vector/batch.hpp"
#include "games/catalogue.hpp"
#include "tests/support/random_image.hpp"

namespace {

std::atomic<long> allocations = 0, bytes_in_use = 0;
std::atomic<long> until_failure = -1;  // how many allocations succeed before one fails; negative: all do

void* counted(std::size_t size, std::size_t alignment) {
  ++allocations;
  if (until_failure >= 0 && until_failure-- == 0) throw std::bad_alloc();
  const std::size_t whole = (size + alignment - 1) / alignment * alignment;
  void* const memory =
      alignment <= alignof(std::max_align_t) ? std::malloc(size) : std::aligned_alloc(alignment, whole);
  if (memory == nullptr) throw std::bad_alloc();
  bytes_in_use += static_cast<long>(malloc_usable_size(memory));
  return memory;
}

void release(void* memory) {
  bytes_in_use -= static_cast<long>(malloc_usable_size(memory));
  std::free(memory);
}

}  // namespace

void* operator new(std::size_t size) { return counted(size, alignof(std::max_align_t)); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t) noexcept { release(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { release(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { release(memory); }

namespace racebeam {
namespace {

struct EpisodeState {
  explicit EpisodeState(const BatchSettings& settings, std::size_t machines = 8)
      : batch(std::vector<Cartridge>(machines, {load_image("builtin:beamfall"), find_game("beamfall")}),
              settings),
        results(batch.make_results()),
        actions(batch.size()) {}

  void step(int times) {
    for (; times > 0; --times) {
      for (int& action : actions) action = static_cast<int>(random() % batch.actions(0).size());
      batch.step(actions, results.arrays());
    }
  }

  Batch batch;
  BatchResults results;
  std::vector<int> actions;
  std::mt19937 random{3};
};

long allocated(EpisodeState& play) {
  const long before = allocations;
  play.step(200);
  return allocations - before;
}

// Each buffer is used for the first time, and each reset is met for the first time; then nothing is
// left to allocate. When that is depends on which thread plays which machine, and on the clock, by which code
// is made: on 25 rounds, or on several times as many where the machine is busy.
TEST_CASE("A batch soon allocates nothing while it runs, episodes that end and begin included") {
  for (const Autoreset autoreset : {Autoreset::kNextStep, Autoreset::kSameStep}) {
    for (const unsigned threads : {1U, 3U}) {
      BatchSettings settings;
      settings.slot.machine.max_episode_frames = 16;
      settings.autoreset = autoreset;
      settings.screens = true;
      settings.threads = threads;
      EpisodeState play(settings);
      INFO("autoreset " << static_cast<int>(autoreset) << ", threads " << threads);
      int quiet = 0;
      for (int round = 0; round < 200 && quiet < 5; ++round) quiet = allocated(play) == 0 ? quiet + 1 : 0;
      CHECK(quiet == 5);
    }
  }
}

// Code is otherwise made once it pays, at moments that depend on the clock. Here all of it is made at once.
const CpuKind kCpu = Translator::obstacle()[0] == '\0' ? CpuKind::kTranslator : CpuKind::kInterpreter;

// Plays the same over and over, until five times in a row `most` allocations are enough.
bool settles(Console& console, long most) {
  constexpr int kFrames = 50;
  int quiet = 0;
  for (int round = 0; round < 200 && quiet < 5; ++round) {
    const long before = allocations;
    for (int frame = 0; frame < kFrames; ++frame) console.step(frame % 2 == 0);
    quiet = allocations - before <= most * kFrames ? quiet + 1 : 0;
  }
  return quiet == 5;
}

TEST_CASE(
    "A console soon allocates nothing while it runs, but copies of its cartridge's RAM: two a frame at "
    "most") {
  for (const std::string_view scheme : test::random_schemes()) {
    Properties properties;
    properties.scheme = scheme;
    SystemGenerator power_on(1);
    Console console(test::random_image(scheme, 1)->bytes, properties, power_on, kCpu);
    INFO("scheme " << scheme << ", cartridge RAM " << console.cartridge_ram().size());
    CHECK(settles(console, console.cartridge_ram().empty() ? 0 : 2));
  }
}

constexpr long kLargePage = 2 << 20;

// Memory of this many machines that have played for a while.
long bytes_taken(std::size_t machines) {
  const long before = bytes_in_use;
  BatchSettings settings;
  settings.threads = 1;
  EpisodeState play(settings, machines);
  play.step(200);
  return bytes_in_use - before + static_cast<long>(large_pages_in_use()) * kLargePage;
}

// A machine has two pictures, the grey one of which it makes the small screen, and a stack of four of these,
// which results have once more. So many machines are compared that a part of a large page makes little
// difference.
TEST_CASE("A machine of a batch takes less than 70 KiB beside its pictures") {
  constexpr long kPictures = 3 * 210 * 160 + 2 * 4 * 84 * 84;
  bytes_taken(48);  // resets that all machines share are met for the first time
  const long of_one = (bytes_taken(336) - bytes_taken(16)) / 320;
  INFO(of_one << " bytes");
  CHECK(of_one > kPictures);
  CHECK(of_one - kPictures < 70 * 1024);
}

// In probes, machines draw pictures. If all did so in the same frames, they would take 67 KiB more each.
TEST_CASE("Machines that nobody looks at have pictures only in their probes, and in turns") {
  constexpr std::size_t kMachines = 64;
  constexpr int kFrames = 3000;
  std::vector<SystemGenerator> power_on(kMachines, SystemGenerator(1));
  std::vector<std::unique_ptr<Console>> consoles;
  const auto image = load_image("builtin:beamfall")->bytes;
  Properties properties;
  properties.format = Format::kNtsc;
  for (SystemGenerator& generator : power_on)
    consoles.push_back(std::make_unique<Console>(image, properties, generator, kCpu));
  const auto step = [&] {
    for (const auto& console : consoles) console->step(false);
  };
  for (int frame = 0; frame < 60; ++frame) step();
  const long at_first = bytes_in_use;
  long most = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    step();
    most = std::max(most, bytes_in_use - at_first);
  }
  const long of_all = 2 * 210 * 160 * static_cast<long>(kMachines);
  INFO(most << " bytes of " << of_all);
  CHECK(most > of_all / 64);  // there are probes
  CHECK(most < of_all / 3);
}

TEST_CASE("A machine that is looked at every 31 frames keeps its pictures") {
  SystemGenerator power_on(1);
  Properties properties;
  properties.format = Format::kNtsc;
  Console console(load_image("builtin:beamfall")->bytes, properties, power_on, kCpu);
  const auto play = [&](int looks, int frames) {
    const long before = allocations;
    for (int frame = 1; frame <= looks * frames; ++frame) {
      console.step(false);
      if (frame % frames == 0) REQUIRE(!console.picture().empty());
    }
    return allocations - before;
  };
  int rounds = 0;
  while (rounds < 50 && play(40, 31) > 0) ++rounds;  // until its code and its logs have their room
  CHECK(rounds < 50);
  CHECK(play(40, 31) == 0);
  CHECK(play(40, 40) >= 40);
}

// How many machines have results among the first `count`, each counted once, that have played.
std::size_t received(const BatchResults& results, std::size_t count) {
  std::set<std::int32_t> machines;
  for (std::size_t place = 0; place < count; ++place)
    if (results.acts[place] == 1) machines.insert(results.numbers[place]);
  return machines.size();
}

TEST_CASE("A machine that fails takes no results of others with it, whichever allocation fails") {
  constexpr std::size_t kMachines = 4;
  int failed_machines = 0, failures = 0;
  for (bool succeeds = false; !succeeds; ++failures) {
    REQUIRE(failures < 1000);
    BatchSettings settings;
    settings.threads = 1;
    settings.screens = true;
    EpisodeState play(settings, kMachines);
    std::vector<std::shared_ptr<const Environment::Saved>> saved;  // hold pictures, which machines must copy
    for (std::size_t machine = 0; machine < kMachines; ++machine)
      saved.push_back(play.batch.slot(machine).environment().save());
    play.batch.send(std::vector<int>(kMachines), std::vector<std::int32_t>{0, 1, 2, 3});
    until_failure = failures;
    try {
      play.batch.receive(play.results.arrays());
      succeeds = true;
    } catch (const std::bad_alloc&) {
      until_failure = -1;
      const std::size_t playing = play.batch.playing();
      INFO("allocation " << failures << ", left " << playing);
      REQUIRE(playing >= kMachines - 1);
      failed_machines += static_cast<int>(kMachines - playing);
      play.batch.receive(play.results.arrays(), playing);
      CHECK(received(play.results, playing) == playing);
      CHECK(play.batch.playing() == 0);
      play.step(2);  // and all of them go on
    }
    until_failure = -1;
  }
  CHECK(failed_machines > 0);
}

TEST_CASE("The count is one of allocations") {
  const long before = allocations;
  std::vector<int> some(100);
  some.resize(10000);
  CHECK(allocations - before == 2);
}

}  // namespace
}  // namespace racebeam
