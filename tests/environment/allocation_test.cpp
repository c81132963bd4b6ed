// What a batch allocates while it runs: nothing. All of this program's allocations are counted, so it has no other test.
#include <atomic>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <new>
#include <random>

#include "environment/batch.hpp"
#include "games/catalogue.hpp"

namespace {

std::atomic<long> allocations = 0;

void* counted(std::size_t size, std::size_t alignment) {
  ++allocations;
  const std::size_t whole = (size + alignment - 1) / alignment * alignment;
  void* const memory = alignment <= alignof(std::max_align_t) ? std::malloc(size) : std::aligned_alloc(alignment, whole);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(std::size_t size) { return counted(size, alignof(std::max_align_t)); }
void* operator new(std::size_t size, std::align_val_t alignment) { return counted(size, static_cast<std::size_t>(alignment)); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

namespace racebeam {
namespace {

struct Play {
  explicit Play(const BatchSettings& settings)
      : batch(std::vector<Cartridge>(8, {load_image("builtin:beamfall"), find_game("beamfall")}), settings),
        actions(batch.size()) {}

  void step(int times) {
    for (; times > 0; --times) {
      for (int& action : actions) action = static_cast<int>(random() % batch.actions(0).size());
      batch.step(actions);
    }
  }

  Batch batch;
  std::vector<int> actions;
  std::mt19937 random{3};
};

long allocated(Play& play) {
  const long before = allocations;
  play.step(200);
  return allocations - before;
}

// Each buffer is used for the first time, and each reset is met for the first time; then there is nothing left to allocate.
TEST_CASE("A batch soon allocates nothing while it runs, episodes that end and begin included") {
  for (const Autoreset autoreset : {Autoreset::kNextStep, Autoreset::kSameStep}) {
    for (const unsigned threads : {1U, 3U}) {
      BatchSettings settings;
      settings.max_episode_frames = 16;
      settings.autoreset = autoreset;
      settings.screens = true;
      settings.threads = threads;
      Play play(settings);
      INFO("autoreset " << static_cast<int>(autoreset) << ", threads " << threads);
      int quiet = 0;
      for (int round = 0; round < 40 && quiet < 5; ++round) quiet = allocated(play) == 0 ? quiet + 1 : 0;
      CHECK(quiet == 5);
    }
  }
}

TEST_CASE("The count is one of allocations") {
  const long before = allocations;
  std::vector<int> some(100);
  some.resize(10000);
  CHECK(allocations - before == 2);
}

}  // namespace
}  // namespace racebeam
