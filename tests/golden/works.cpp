#include "tests/golden/works.hpp"

#include <array>

#include "games/catalogue.hpp"
#include "games/files/game_file.hpp"
#include "games/md5.hpp"
#include "tests/support/random_image.hpp"
#include "tests/support/roms.hpp"

namespace racebeam::test {
namespace {

constexpr int kActs = 1500, kActsALine = 250;
constexpr int kProgramActs = 120, kImagesAScheme = 4;
constexpr int kImageActs = 150;

struct NamedSettings {
  const char* name;
  Settings settings;
  bool other_variation = false;  // the last mode and difficulty that the game offers
};

Settings settings(float sticky, int frame_skip) {
  Settings settings;
  settings.random_seed = 7;
  settings.sound = true;
  settings.sticky = sticky;
  settings.frame_skip = frame_skip;
  return settings;
}

std::vector<NamedSettings> all_settings() {
  Settings averaged = settings(0.25F, 1), limited = settings(0.25F, 4), classic = settings(0.25F, 4);
  averaged.color_averaging = true;
  limited.max_episode_frames = 500;
  limited.truncate_on_life_loss = true;
  limited.reward_min = -1;
  limited.reward_max = 1;
  limited.system_seed = 99;
  classic.classic = true;
  return {{"plain", settings(0, 1)},
          {"sticky actions, four frames an act", settings(0.25F, 4)},
          {"last mode and difficulty", settings(0, 4), true},
          {"averaged colours", averaged},
          {"an episode of 500 frames or one life, clipped rewards, another power-on", limited},
          {"classic", classic}};
}

// Television standards and controllers, for programs that are not games.
std::shared_ptr<const Game> program_game(std::string_view scheme, int number) {
  static constexpr std::array kProperties = {"", "format = \"PAL\"", "format = \"SECAM\"",
                                             "left = \"paddles\"\nystart = 40"};
  const std::string text = "title = \"Program\"\n[[image]]\nscheme = \"" + std::string(scheme) + "\"\n" +
                           kProperties[static_cast<std::size_t>(number) % kProperties.size()] + "\n";
  return std::make_shared<const Game>(parse_game(text, "program", "program.toml"));
}

Work program(const std::string& name, std::shared_ptr<const Image> image, std::string_view scheme,
             int number) {
  return {name,         std::move(image), program_game(scheme, number), settings(0, 1), 0, 0,
          kProgramActs, kProgramActs};
}

}  // namespace

std::vector<Work> works_of(const std::string& name) {
  std::vector<Work> works;
  const auto image = load_image("builtin:" + name);
  const auto game = find_game(name);
  for (const NamedSettings& one : all_settings()) {
    Work work{one.name, image, game, one.settings, game->default_mode, 0, kActs, kActsALine};
    if (one.other_variation) {
      work.mode = game->modes.back();
      work.difficulty = game->difficulties.back();
    }
    works.push_back(work);
  }
  return works;
}

std::vector<Work> works_of_programs() {
  std::vector<Work> works = {program("functional", load_image(RACEBEAM_FUNCTIONAL_PROGRAM), "4K", 0)};
  for (const std::string_view scheme : random_schemes())
    for (int i = 0; i < kImagesAScheme; ++i)
      works.push_back(program(std::string(scheme) + " " + std::to_string(i),
                              random_image(scheme, static_cast<unsigned>(i)), scheme, i));
  return works;
}

std::vector<Work> works_of_images(int frames) {
  std::vector<Work> works;
  for (const CatalogueEntry& entry : catalogue()) {
    const auto game = find_game(entry.name);
    const auto image = entry.built_in ? nullptr : find_rom_of(*game);
    if (!image) continue;
    Settings first = settings(0.25F, 4), last = settings(0.25F, 1);
    last.color_averaging = true;
    const auto add = [&](const std::string& name, const Settings& settings, int mode, int difficulty) {
      const int acts = frames > 0 ? frames / settings.frame_skip : kImageActs;
      works.push_back({name, image, game, settings, mode, difficulty, acts, acts});
    };
    add(game->name, first, game->default_mode, 0);
    add(game->name + ", last mode and difficulty", last, game->modes.back(), game->difficulties.back());
  }
  return works;
}

}  // namespace racebeam::test
