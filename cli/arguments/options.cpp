#include "cli/arguments/options.hpp"

#include <chrono>
#include <iostream>
#include <limits>

#include "games/catalogue.hpp"
#include "games/rom_image.hpp"
#include "system/invalid_input.hpp"
#include "system/printable.hpp"

namespace racebeam {
namespace {

constexpr std::int64_t kMaxInt = std::numeric_limits<int>::max();
constexpr std::int64_t kMaxSeed = std::numeric_limits<std::uint32_t>::max();

void warn_about(const Recognition& recognition, const Image& image, const Tell& tell) {
  const Game& game = *recognition.game;
  if (recognition.how == RecognisedBy::kNothing) {
    tell(
        "'" + image.stem + "' (MD5 " + image.md5 +
        ") is not in the catalogue: it runs without a score; --game NAME or --game-file FILE selects a rule");
  }
  if (const std::string warning = image_warning(game, image); !warning.empty()) tell(warning);
}

// The keys of PropertyOverrides.
struct ConsoleOption {
  const char *key, *value, *help;
};
constexpr ConsoleOption kConsoleOptions[] = {
    {"scheme", "NAME", "Cartridge scheme of the image, such as F8; auto: detected"},
    {"left", "CONTROLLER", "Controller in the left port: joystick, paddles, keyboard, ..."},
    {"right", "CONTROLLER", "Controller in the right port, as for --left"},
    {"format", "FORMAT", "Television standard: auto, ntsc, pal, pal60 or secam"},
    {"ystart", "LINE", "First line of the picture, 0 to 50"},
    {"height", "LINES", "Lines of the picture, 100 to 256"},
};

void add_console_options(Subcommand& command, PropertyOverrides& console) {
  for (const auto& [key, value, help] : kConsoleOptions) {
    const auto refusal = [name = key](const std::string& text) -> std::string {
      try {
        PropertyOverrides{}.set(name, text);
        return "";
      } catch (const InvalidInput& error) {
        return error.what();
      }
    };
    const std::function<void(const std::string&)> set = [&console, name = key](const std::string& text) {
      console.set(name, text);
    };
    command.option("--" + std::string(key), set, help).check({refusal, ""}).value_name(value);
  }
}

}  // namespace

Option add_count(Subcommand& command, const std::string& name, int& value, int least,
                 const std::string& help) {
  return command.option(name, value, help).check(whole_number(least, kMaxInt)).shows_default();
}

void add_cpu_option(Subcommand& command, CpuKind& cpu) {
  command.choice<CpuKind>(
      "--cpu", cpu,
      {{"auto", CpuKind::kAuto},
       {"interpreter", CpuKind::kInterpreter},
       {"translator", CpuKind::kTranslator}},
      "auto",
      "How instructions are executed; auto: they are translated where that saves time and the system permits "
      "it; translator: they are always translated; interpreter: they are never translated");
}

void add_machine_options(Subcommand& command, MachineOptions& options) {
  Settings& settings = options.settings;
  command.option("--rom", options.rom, "The cartridge image: a file, or builtin:NAME")
      .value_name("FILE")
      .required();
  Option game =
      command.option("--game", options.game, "Use the rule of this game of the catalogue (racebeam games)");
  game.value_name("NAME");
  command
      .option(
          "--game-file", options.game_file,
          "Use the rule of this game file for the image of --rom, and for those images of --roms and "
          "built-in ones that the file lists. FILE may be a folder of game files, each for its own images")
      .value_name("FILE")
      .excludes(game);
  add_console_options(command, options.console);
  const auto add_seed = [&command](const std::string& name, std::uint32_t& seed, const std::string& help) {
    command.option(name, seed, help).check(whole_number(0, kMaxSeed)).shows_default();
  };
  add_seed("--seed", settings.random_seed, "Seed of the sticky actions; 0: drawn from the clock");
  add_seed("--system-seed", settings.system_seed, "Seed of the memory's contents at power-on");
  add_count(command, "--frame-skip", settings.frame_skip, 1, "Frames that an action lasts");
  command.option("--sticky", settings.sticky, "Probability that a frame repeats the previous action")
      .check(number(0, 1, "0..1"))
      .shows_default();
  command.flag("--color-averaging", settings.color_averaging, "Blend each picture with the previous one");
  command.choice<Rules>(
      "--rules", settings.rules, {{"ale-0.12", Rules::kAle012}, {"fixed", Rules::kFixed}}, "ale-0.12",
      "Rules for rewards, lives and end: ale-0.12, or fixed, with corrections (racebeam games --rules)");
  add_cpu_option(command, settings.cpu);
  command.option("--mode", options.mode, "Game variation (racebeam games lists them)")
      .check(whole_number(0, kMaxInt));
  command.option("--difficulty", options.difficulty, "Difficulty switches (racebeam games lists them)")
      .check(whole_number(0, kMaxInt));
}

void tell_on_standard_error(const std::string& sentence) {
  std::cerr << "racebeam: " << printable(sentence) << "\n";
}

Cartridge open_cartridge(const MachineOptions& options, const Tell& tell) {
  const auto image = load_image(options.rom);
  const Recognition recognition = recognise(*image, options.game, options.game_file);
  const Cartridge cartridge{image, with_overrides(recognition.game, *image, options.console)};
  power_on(cartridge, options);
  warn_about(recognition, *image, tell);
  return cartridge;
}

Environment power_on(const Cartridge& cartridge, const MachineOptions& options, Pace* pace) {
  Environment environment(cartridge.image, cartridge.game, options.settings, pace);
  if (options.mode) environment.set_mode(*options.mode);
  if (options.difficulty) environment.set_difficulty(*options.difficulty);
  if (options.mode || options.difficulty) environment.reset_game();
  return environment;
}

Environment open_environment(const MachineOptions& options) {
  return power_on(open_cartridge(options), options);
}

std::uint32_t resolve_seed(std::uint32_t seed) {
  if (seed != 0) return seed;
  const auto now = static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch().count());
  return static_cast<std::uint32_t>(now ^ (now >> 32)) | 1U;
}

}  // namespace racebeam
