#include "cli/classic.hpp"

#include <algorithm>
#include <iostream>

#include "cli/classic_settings.hpp"
#include "cli/options.hpp"
#include "games/catalogue.hpp"
#include "server/log.hpp"
#include "server/server.hpp"

namespace racebeam {
namespace {

constexpr auto kAbout = "Serve as ALE 0.4 to 0.6 did, given its command line: for old launchers";

constexpr auto kUsage = R"(racebeam classic -game_controller fifo|fifo_named [-key value]... IMAGE

  -game_controller NAME                  fifo: standard streams; fifo_named: ale_fifo_out and ale_fifo_in
  -random_seed N                         0 or time: from the clock
  -run_length_encoding true|false        how a screen is written (true)
  -frame_skip N                          frames that an action lasts (1)
  -repeat_action_probability P           that a frame repeats the action before it (0.25)
  -max_num_frames N                      frames after which the session ends (0: none)
  -max_num_frames_per_episode N          frames after which an episode ends (0: none)
  -color_averaging true|false            blend each picture with the one before it (false)
  -config FILE                           lines of key = value, which win over the command line

Other keys are ignored. ale.cfg in the working directory is read first. The image's name tells the game.)";

// What these did needs a window or a sound card.
constexpr const char* kIgnored[] = {"display_screen", "sound", "record_screen_dir", "record_sound_filename"};

void mention_ignored(const ClassicSettings& settings) {
  for (const char* key : kIgnored) {
    const std::string value = settings.text(key);
    if (!value.empty() && value != "false" && value != "0") log(std::string("-") + key + " is ignored");
  }
}

MachineOptions machine_options(const ClassicSettings& settings) {
  MachineOptions options;
  options.rom = settings.image();
  options.settings.classic = true;
  options.settings.random_seed = resolve_seed(static_cast<std::uint32_t>(settings.number("random_seed", 0)));
  options.settings.frame_skip = std::max(1, settings.number("frame_skip", 1));
  options.settings.sticky = std::clamp(settings.real("repeat_action_probability", 0.25F), 0.0F, 1.0F);
  options.settings.max_episode_frames = std::max(0, settings.number("max_num_frames_per_episode", 0));
  options.settings.color_averaging = settings.truth("color_averaging", false);
  return options;
}

// By the file's stem alone, whatever the image.
Cartridge open_by_name(const MachineOptions& machine) {
  const auto image = load_image(machine.rom);
  const auto game = find_game(image->stem);
  if (!game)
    throw std::invalid_argument("no game is called '" + image->stem + "', as " + machine.rom + " is");
  const Cartridge cartridge{image, game};
  power_on(cartridge, machine);  // what does not work should show before anything else is said
  if (!game->accepts(image->md5)) log("the MD5 of " + machine.rom + " is not one known for " + game->name);
  return cartridge;
}

// Whether the pipes are named.
bool check_controller(const std::string& name) {
  if (name == "rlglue")
    throw std::invalid_argument("-game_controller rlglue is not built yet, fifo and fifo_named are");
  if (name != "fifo" && name != "fifo_named") {
    throw std::invalid_argument("-game_controller '" + name + "' is neither fifo nor fifo_named");
  }
  return name == "fifo_named";
}

int run(const std::vector<std::string>& words) {
  if (ClassicSettings::asks_for_help(words)) {
    std::cerr << kUsage << "\n";
    return kExitFailure;
  }
  const ClassicSettings settings(words);
  const bool named = check_controller(settings.text("game_controller"));
  const MachineOptions machine = machine_options(settings);
  const Cartridge cartridge = open_by_name(machine);
  mention_ignored(settings);
  const ClassicOptions protocol{settings.truth("run_length_encoding", true),
                                settings.number("max_num_frames", 0)};
  const ClassicService service{[&](Pace* pace) { return power_on(cartridge, machine, pace); }, protocol, nullptr};
  ServerSettings server;
  server.endpoints = {{named ? Address(AlePipes{}) : Address(StandardStreams{}), true}};
  Services services;
  services.classic = service;
  return serve(server, services);
}

}  // namespace

void add_classic(CLI::App& app) {
  CLI::App* command = app.add_subcommand("classic", kAbout);
  command->set_help_flag();
  command->prefix_command();  // the words are not CLI11's to understand
  command->callback([command] { throw CLI::RuntimeError(run(command->remaining())); });
}

}  // namespace racebeam
