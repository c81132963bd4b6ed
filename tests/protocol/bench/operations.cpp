// operations OPERATION TIMES GAME: plays a game of the catalogue with random actions, and does the operation
// that many times. Not a test. platforms/instructions --operations counts what this executes.
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "environment/environment.hpp"
#include "environment/observe/preprocess.hpp"
#include "environment/observe/screen_stack.hpp"
#include "protocol/encoding/text.hpp"
#include "tests/support/roms.hpp"

namespace racebeam {
namespace {

using Screen = std::vector<std::uint8_t>;

// Draws every frame: otherwise measured times would decide which are drawn, and the counts would vary.
class Player {
 public:
  explicit Player(std::string_view name) : game_(find_game(name)), machine_(image(), game_, settings()) {
    machine_.set_drawing(Drawing::kEvery);
  }

  Environment& machine() { return machine_; }

  void act(int frames) {
    if (machine_.game_over()) machine_.reset_game();
    const auto& actions = game_->legal_actions;
    machine_.act_for(frames, actions[random_() % actions.size()]);
  }

 private:
  // --cpu auto would translate at times that depend on the clock.
  static Settings settings() { return {.cpu = CpuKind::kTranslator}; }

  std::shared_ptr<const Image> image() const {
    if (game_->name == "beamfall" || game_->name == "updraft") return load_image("builtin:" + game_->name);
    if (auto image = test::find_rom_of(*game_)) return image;
    std::fprintf(stderr, "operations: no image of %s was found (RACEBEAM_ROMS)\n", game_->name.c_str());
    std::exit(2);
  }

  std::shared_ptr<const Game> game_;
  Environment machine_;
  std::mt19937 random_{7};
};

// Of 60 frames: what an observation is made of, with the frame before.
struct Pictures {
  Screen screen, previous;
};

std::vector<Pictures> pictures_of(Player& player) {
  std::vector<Pictures> all;
  while (all.size() < 60) {
    player.act(10);
    const auto screen = player.machine().screen(), previous = player.machine().previous_screen();
    all.push_back({{screen.begin(), screen.end()}, {previous.begin(), previous.end()}});
  }
  return all;
}

void frames(Player& player, int times) {
  for (; times > 0; --times) {
    player.act(1);
    static_cast<void>(player.machine().screen());
  }
}

void steps(Player& player, int times) {
  ScreenStack stack({}, player.machine());
  Screen to(stack.size());
  for (; times > 0; --times) {
    player.act(4);
    stack.look(player.machine(), true);
    stack.push();
    stack.copy_to(to);
  }
}

// Does the operation with one picture after the other.
template <typename Operation>
void with_pictures(Player& player, int times, Operation operation) {
  const auto pictures = pictures_of(player);
  for (int i = 0; i < times; ++i) operation(pictures[static_cast<std::size_t>(i) % pictures.size()]);
}

// Makes the brighter of a picture and the one before it.
class PlaneMaker {
 public:
  explicit PlaneMaker(Environment& machine)
      : brightness_(grey_table(machine.format())), stale_(static_cast<std::size_t>(machine.height()), 1) {}

  void make(const Pictures& of, Screen& plane) const {
    make_brighter_plane(of.screen, of.previous, brightness_, stale_, plane);
  }

 private:
  Brightness brightness_;
  Screen stale_;  // all rows
};

void planes(Player& player, int times) {
  const PlaneMaker maker(player.machine());
  Screen plane(player.machine().screen().size());
  with_pictures(player, times, [&](const Pictures& of) { maker.make(of, plane); });
}

void resizes(Player& player, int times) {
  const PlaneMaker maker(player.machine());
  const AreaResize resize(kScreenWidth, player.machine().height(), kSmallSide, kSmallSide);
  std::vector<Screen> planes;
  for (const Pictures& of : pictures_of(player)) maker.make(of, planes.emplace_back(of.screen.size()));
  Screen small(kSmallSide * kSmallSide);
  for (int i = 0; i < times; ++i) resize(planes[static_cast<std::size_t>(i) % planes.size()], small);
}

template <typename Append>
void texts(Player& player, int times, Append append) {
  std::string text;
  with_pictures(player, times, [&](const Pictures& of) {
    text.clear();
    append(text, of.screen);
  });
}

int run(std::string_view operation, int times, std::string_view game) {
  Player player(game);
  if (operation == "frame") return frames(player, times), 0;
  if (operation == "step") return steps(player, times), 0;
  if (operation == "brighter") return planes(player, times), 0;
  if (operation == "resize") return resizes(player, times), 0;
  if (operation == "runs")
    return texts(player, times, [](std::string& out, const Screen& of) { append_run_length(out, of); }), 0;
  if (operation == "hex")
    return texts(player, times, [](std::string& out, const Screen& of) { append_hex(out, of); }), 0;
  std::fputs("operations: unknown operation; accepted: frame, step, brighter, resize, runs, hex\n", stderr);
  return 2;
}

}  // namespace
}  // namespace racebeam

int main(int argc, char** argv) {
  if (argc == 4) return racebeam::run(argv[1], std::atoi(argv[2]), argv[3]);
  std::fputs("usage: operations OPERATION TIMES GAME\n", stderr);
  return 2;
}
