// Machines of a batch look only at rows that have changed. Beside each is a single machine, which draws every
// frame, and whose screens are read and resized as a whole.
#include <algorithm>
#include <catch2/catch.hpp>
#include <list>
#include <random>

#include "environment/vector/batch.hpp"
#include "tests/environment/observe/whole_stack.hpp"
#include "tests/environment/steered.hpp"
#include "tests/support/random_image.hpp"
#include "tests/support/roms.hpp"

namespace racebeam {
namespace {

using test::Bytes;
using test::WholeStack;

std::vector<Cartridge> different_games() {
  std::vector<Cartridge> all{{load_image("builtin:beamfall"), find_game("beamfall")},
                             {load_image("builtin:updraft"), find_game("updraft")},
                             {test::counter_image(), test::game()}};
  for (const char* scheme : {"4K", "F8"})
    all.push_back({test::random_image(scheme, 9), test::random_game(scheme)});
  for (const char* name : {"asteroids", "qbert", "freeway"}) {
    const auto game = find_game(name);
    if (const auto image = test::find_rom_of(*game)) all.push_back({image, game});
  }
  return all;
}

class Single {
 public:
  Single(const Cartridge& cartridge, const BatchSettings& settings, const Slot& slot)
      : machine_(cartridge.image, cartridge.game, test::plain()),
        settings_(settings),
        stack_(slot.stack()->settings(), machine_) {
    begin(slot);
  }

  // An episode begins, or a state was loaded that has no stack of these screens.
  void begin(const Slot& slot) {
    stack_.clear();
    follow(slot);
    look(slot);
  }

  void step(const Slot& slot, bool was_finished, int action) {
    if (was_finished || (slot.outcome().finished && settings_.autoreset == Autoreset::kSameStep))
      return begin(slot);
    if (slot.outcome().finished) {  // slot_test.cpp has what is seen last
      follow(slot);
      return stack_.set_bytes(slot.stack()->bytes());
    }
    for (int frame = 0; frame < settings_.slot.machine.frame_skip; ++frame)
      machine_.act(slot.actions()[static_cast<std::size_t>(action)]);
    look(slot);
  }

  void load(const Slot& slot, const Bytes& stack) {
    follow(slot);
    stack_.set_bytes(stack);
  }

  Bytes bytes() const { return stack_.bytes(); }

 private:
  void follow(const Slot& slot) { machine_.restore(*slot.environment().save(true)); }
  void look(const Slot& slot) {
    stack_.look(machine_, slot.blends());
    stack_.push();
  }

  Environment machine_;
  const BatchSettings& settings_;
  WholeStack stack_;
};

struct Loaded {
  Slot::Saved state;
  std::size_t game;
  Bytes stack;
};

// A batch, and a single machine for each of its own.
class Beside {
 public:
  Beside(const std::vector<Cartridge>& cartridges, const BatchSettings& settings)
      : settings_(settings), batch_(cartridges, settings), results_(batch_.make_results()) {
    for (std::size_t i = 0; i < batch_.size(); ++i)
      singles_.emplace_back(cartridges[i], settings_, batch_.slot(i));
  }

  void step(std::mt19937& random, bool observes) {
    std::vector<int> actions;
    Bytes was_finished;
    for (std::size_t i = 0; i < batch_.size(); ++i) {
      actions.push_back(static_cast<int>(random() % batch_.actions(i).size()));
      was_finished.push_back(batch_.slot(i).finished());
    }
    BatchArrays to = results_.arrays();
    if (!observes) to.observations = {};
    batch_.step(actions, to);
    for (std::size_t i = 0; i < batch_.size(); ++i)
      singles_[i].step(batch_.slot(i), was_finished[i] != 0, actions[i]);
    if (observes) check(results_.observations);
  }

  void reset(std::mt19937& random) {
    Bytes chosen(batch_.size());
    std::vector<std::int64_t> seeds(batch_.size());
    for (std::size_t i = 0; i < batch_.size(); ++i) {
      chosen[i] = random() % 3 == 0;
      seeds[i] = static_cast<std::int64_t>(random() % 3) - 1;
    }
    batch_.reset(results_.arrays(), chosen, seeds);
    for (std::size_t i = 0; i < batch_.size(); ++i)
      if (chosen[i] != 0) singles_[i].begin(batch_.slot(i));
    check(results_.observations);
  }

  Loaded save(std::size_t i) { return {batch_.slot(i).save(true, true), i, singles_[i].bytes()}; }

  void load(const Loaded& loaded) {
    Slot& slot = batch_.slot(loaded.game);
    slot.restore(loaded.state);
    if (slot.stack()->settings() == loaded.state.stack_settings) {
      singles_[loaded.game].load(slot, loaded.stack);
    } else {
      singles_[loaded.game].begin(slot);
    }
    show();
  }

  // The machine has no screens for a while.
  void forget(std::size_t i) {
    Slot& slot = batch_.slot(i);
    slot.set_stack({});
    slot.environment().release_caches();
    slot.set_stack(settings_.stack);
    singles_[i].begin(slot);
    show();
  }

  std::size_t size() const { return batch_.size(); }

 private:
  void show() {
    batch_.show(results_.arrays());
    check(results_.observations);
  }
  void check(const Bytes& observations) const {
    const std::size_t size = batch_.observation_size();
    for (std::size_t i = 0; i < batch_.size(); ++i) {
      INFO("machine " << i);
      REQUIRE(std::ranges::equal(std::span(observations).subspan(i * size, size), singles_[i].bytes()));
    }
  }

  const BatchSettings settings_;
  Batch batch_;
  BatchResults results_;
  std::vector<Single> singles_;
};

BatchSettings settings(int frame_skip, bool max_pool, Autoreset autoreset, const StackSettings& stack) {
  BatchSettings all;
  all.slot.machine.random_seed = 5;
  all.slot.machine.frame_skip = frame_skip;
  all.slot.machine.max_episode_frames = 90;
  all.slot.max_pool = max_pool;
  all.slot.noop_max = 9;
  all.autoreset = autoreset;
  all.stack = stack;
  all.threads = 2;
  return all;
}

TEST_CASE("A batch that skips unchanged rows shows what single machines show of which every row is read") {
  // States go from one batch to another, so the frame skip changes, and so do the screens.
  const std::vector<Cartridge> games = different_games();
  constexpr StackSettings kGrey, kColour{.depth = 2, .width = 96, .height = 50, .rgb = true};
  std::list<Beside> batches;
  batches.emplace_back(games, settings(4, true, Autoreset::kNextStep, kGrey));
  batches.emplace_back(games, settings(1, true, Autoreset::kSameStep, kGrey));
  batches.emplace_back(games, settings(2, true, Autoreset::kSameStep, kColour));
  batches.emplace_back(games, settings(3, false, Autoreset::kNextStep, {.depth = 1}));
  std::mt19937 random(8);
  std::vector<Loaded> loaded{batches.front().save(0)};
  for (int round = 0; round < 150; ++round) {
    INFO("round " << round);
    for (Beside& batch : batches) {
      batch.step(random, random() % 4 != 0);
      if (random() % 5 == 0) loaded.push_back(batch.save(random() % batch.size()));
      // Twice, the second time shows the same lines.
      if (random() % 5 == 0) {
        const Loaded& one = loaded[random() % loaded.size()];
        for (auto times = random() % 3; times < 3; ++times) batch.load(one);
      }
      if (random() % 15 == 0) {
        for (auto times = random() % 3; times < 3; ++times) batch.reset(random);
      }
      if (random() % 15 == 0) batch.forget(random() % batch.size());
    }
  }
}

}  // namespace
}  // namespace racebeam
