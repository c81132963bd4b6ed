// DISCO sees the objects that decide two of the paper's training games.
#include <catch2/catch.hpp>
#include <map>

#include "agents/base/episode_start.hpp"
#include "agents/features/object_features.hpp"
#include "tests/agents/experiment/samples.hpp"
#include "tests/support/needed_rom.hpp"

using namespace racebeam;
using namespace racebeam::test;

namespace {

constexpr int kNoop = 0, kUp = 2, kDown = 5;

// A game that is played, and the instances of its classes.
class Seen {
 public:
  explicit Seen(const Cartridge& cartridge)
      : settings_{1, 2000, 4000, short_episodes(18000)},
        machine_(cartridge.image, cartridge.game, settings_.play.machine),
        background_(discover_background(cartridge, settings_)),
        finder_(background_, discover_classes(cartridge, settings_, background_),
                reach_of(settings_.play.machine.frame_skip)) {
    begin_episode(machine_, settings_.play, 1);
    machine_.set_drawing(Drawing::kLast);
  }

  const std::vector<Instance>& after(int action) {
    machine_.act(action);
    return finder_.find(screen_.of(machine_));
  }

 private:
  SampleSettings settings_;
  Environment machine_;
  FeatureScreen screen_;
  Background background_;
  InstanceFinder finder_;
};

}  // namespace

// Nothing else goes up and down.
TEST_CASE("The hero of Asterix is of a class, and its velocity is known") {
  const auto image = needed_rom_of("asterix");
  if (!image) return;
  Seen asterix({image, find_game("asterix")});
  for (int decision = 0; decision < 20; ++decision) asterix.after(kNoop);
  std::map<std::uint32_t, int> obeyed;  // by objects of each class; less those that went the other way
  for (int decision = 0; decision < 40; ++decision) {
    const bool up = decision % 4 < 2;
    for (const Instance& instance : asterix.after(up ? kUp : kDown))
      if (instance.velocity.y != 0) obeyed[instance.class_number] += (instance.velocity.y < 0) == up ? 1 : -1;
  }
  const auto most = std::ranges::max_element(obeyed, {}, [](const auto& each) { return each.second; });
  REQUIRE(most != obeyed.end());
  CHECK(most->second >= 15);  // the hero moves in every other decision
}

TEST_CASE("The invaders of Space Invaders are of classes") {
  const auto image = needed_rom_of("space_invaders");
  if (!image) return;
  Seen invaders({image, find_game("space_invaders")});
  int least = 100;  // of 36
  for (int decision = 0; decision < 60; ++decision) {
    const auto& instances = invaders.after(kNoop);
    if (decision < 20) continue;  // they appear
    const auto count = std::ranges::count_if(
        instances, [](const Instance& each) { return each.box.height >= 7 && each.box.y() < 140; });
    least = std::min(least, static_cast<int>(count));
  }
  CHECK(least >= 30);
}

// As in the paper's figure of DISCO: all fish, and the icons of lives, which are as large as a fish.
TEST_CASE("The fish of Seaquest are one class, whatever step of their way is shown") {
  const auto image = needed_rom_of("seaquest");
  if (!image) return;
  Seen seaquest({image, find_game("seaquest")});
  constexpr int kIconTop = 22;
  std::map<std::uint32_t, int> fish, icons;  // by class
  for (int decision = 0; decision < 100; ++decision)
    for (const Instance& instance : seaquest.after(kNoop)) {
      if (instance.box.top == kIconTop) ++icons[instance.class_number];
      if (instance.box.width == 8 && instance.box.height == 7) ++fish[instance.class_number];
    }
  REQUIRE(fish.size() == 1);
  CHECK(fish.begin()->second > 100);
  REQUIRE(icons.size() == 1);
  CHECK(icons.begin()->first == fish.begin()->first);
}
