#include "cli/arguments/options.hpp"

#include <chrono>
#include <iostream>
#include <limits>
#include <map>

#include "games/catalogue.hpp"
#include "games/rom_image.hpp"
#include "protocol/line/words.hpp"
#include "system/printable.hpp"

namespace racebeam {
namespace {

constexpr std::int64_t kMostInt = std::numeric_limits<int>::max();
constexpr std::int64_t kMostSeed = std::numeric_limits<std::uint32_t>::max();

// CLI::Range accepts "nan".
CLI::Validator probability() {
  const auto check = [](const std::string& text) {
    const auto value = parse_number<double>(text);
    const bool accepted = value && *value >= 0 && *value <= 1;
    return accepted ? std::string{} : "'" + text + "' is not a probability from 0 to 1";
  };
  return CLI::Validator(check, "0..1");
}

CLI::Validator one_of(const std::map<std::string, Rules>& rules) {
  const auto check = [rules](const std::string& text) {
    return rules.contains(text) ? std::string{}
                                : "'" + text + "' is not known; accepted are ale-0.12 and fixed";
  };
  return CLI::Validator(check, "");
}

void warn_about(const Recognition& recognition, const Image& image, const Tell& tell) {
  const Game& game = *recognition.game;
  if (recognition.how == RecognisedBy::kNothing) {
    tell(
        "'" + image.stem + "' (MD5 " + image.md5 +
        ") is not in the catalogue: it runs without a score; --game NAME or --game-file FILE selects a rule");
  } else if (!recognition.md5_matches) {
    tell("the MD5 of this image, " + image.md5 + ", is not that of the image which the rule of '" +
         game.name + "' was written for; score and end may be wrong");
  }
}

const std::map<std::string, CpuKind> kCpuKinds = {
    {"auto", CpuKind::kAuto}, {"interpreter", CpuKind::kInterpreter}, {"translator", CpuKind::kTranslator}};

}  // namespace

// Checks the text before CLI11 converts it, because CLI11's message does not say what is accepted.
CLI::Validator whole_number(std::int64_t least, std::int64_t most) {
  const auto check = [least, most](const std::string& text) {
    const auto number = parse_number<std::int64_t>(text);
    const bool accepted = number && *number >= least && *number <= most;
    if (accepted) return std::string{};
    return "'" + text + "' is not a whole number from " + std::to_string(least) + " to " +
           std::to_string(most);
  };
  return CLI::Validator(check, "");
}

CLI::Option* add_count(CLI::App& app, const std::string& name, int& value, int least,
                       const std::string& help) {
  return app.add_option(name, value, help)->check(whole_number(least, kMostInt))->capture_default_str();
}

void add_cpu_option(CLI::App& app, CpuKind& cpu) {
  const auto set_cpu = [&cpu](const std::string& name) { cpu = kCpuKinds.at(name); };
  app.add_option_function<std::string>(
         "--cpu", set_cpu,
         "How instructions are executed; auto: translated where that saves time and the system permits it; "
         "translator: all code is translated at once, whatever that costs; interpreter: no code is")
      ->check(CLI::IsMember(kCpuKinds))
      ->default_str("auto");
}

void add_machine_options(CLI::App& app, MachineOptions& options) {
  Settings& settings = options.settings;
  app.add_option("--rom", options.rom, "The cartridge image: a file, or builtin:NAME")->required();
  CLI::Option* game =
      app.add_option("--game", options.game, "Use the rule of this game of the catalogue (racebeam games)");
  app.add_option("--game-file", options.game_file, "Use the rule of this game file")->excludes(game);
  const auto add_seed = [&app](const std::string& name, std::uint32_t& seed, const std::string& help) {
    app.add_option(name, seed, help)->check(whole_number(0, kMostSeed))->capture_default_str();
  };
  add_seed("--seed", settings.random_seed, "Seed of the sticky actions; 0: from the clock");
  add_seed("--system-seed", settings.system_seed, "Seed of the memory's contents at power-on");
  add_count(app, "--frame-skip", settings.frame_skip, 1, "Frames of an action");
  app.add_option("--sticky", settings.sticky, "Probability that a frame repeats the previous action")
      ->check(probability())
      ->capture_default_str();
  app.add_flag("--color-averaging", settings.color_averaging, "Blend each picture with the previous one");
  const std::map<std::string, Rules> rules = {{"ale-0.12", Rules::kAle012}, {"fixed", Rules::kFixed}};
  app.add_option_function<std::string>(
         "--rules", [&settings, rules](const std::string& name) { settings.rules = rules.at(name); },
         "Rules for rewards, lives and end: ale-0.12, or fixed, with corrections (racebeam games --rules)")
      ->check(one_of(rules))
      ->default_str("ale-0.12")
      ->type_name("NAME");
  add_cpu_option(app, settings.cpu);
  app.add_option("--mode", options.mode, "Game variation (racebeam games lists them)")
      ->check(whole_number(0, kMostInt));
  app.add_option("--difficulty", options.difficulty, "Difficulty switches (racebeam games lists them)")
      ->check(whole_number(0, kMostInt));
}

void tell_on_standard_error(const std::string& sentence) {
  std::cerr << "racebeam: " << printable(sentence) << "\n";
}

Cartridge open_cartridge(const MachineOptions& options, const Tell& tell) {
  const auto image = load_image(options.rom);
  const Recognition recognition = recognise(*image, options.game, options.game_file);
  const Cartridge cartridge{image, recognition.game};
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
