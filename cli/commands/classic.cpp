#include "cli/commands/classic.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <iostream>

#include "cli/arguments/options.hpp"
#include "cli/commands/classic_settings.hpp"
#include "cli/commands/png_file.hpp"
#include "games/catalogue.hpp"
#include "server/operation/log.hpp"
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
  -record_screen_dir FOLDER              write 000000.png and on there: the screen before each frame
  -config FILE                           lines of key = value, which win over the command line

Other keys are ignored. ale.cfg in the working directory is read first. The image's name tells the game, such
as pong.bin; an image under another name is known by its MD5. A program called ale or racebeam-ale is this one.)";

// What these did needs a window or a sound card.
constexpr const char* kIgnored[] = {"display_screen", "sound", "record_sound_filename"};

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
  options.settings.random_seed = resolve_seed(settings.seed("random_seed"));
  options.settings.frame_skip = std::max(1, settings.number("frame_skip", 1));
  options.settings.sticky = std::clamp(settings.real("repeat_action_probability", 0.25F), 0.0F, 1.0F);
  options.settings.max_episode_frames = std::max(0, settings.number("max_num_frames_per_episode", 0));
  options.settings.color_averaging = settings.truth("color_averaging", false);
  return options;
}

// By the file's stem, whatever the image; where no game is called so, by the image's MD5.
Cartridge open_by_name(const MachineOptions& machine) {
  const auto image = load_image(machine.rom);
  auto game = find_game(image->stem);
  if (!game) game = find_game_by_md5(image->md5);
  if (!game)
    throw std::invalid_argument("no game is called '" + image->stem + "', as " + machine.rom +
                                " is, and its MD5, " + image->md5 +
                                ", is not known; name the file as its game");
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

// The screens of one session, numbered from 000000.png on, as ALE 0.6 writes them: a file that is there is
// written over, and a folder that cannot be written to costs the pictures, but not the session.
class ScreenFolder {
 public:
  explicit ScreenFolder(std::string path) : path_(std::move(path)) {}

  void add(const Environment& machine) {
    if (failed_) return;
    std::array<char, 24> name{};
    std::snprintf(name.data(), name.size(), "/%06d.png", number_++);
    machine.screen_rgb(rgb_);
    try {
      write_png(path_ + name.data(), rgb_);
    } catch (const std::exception& error) {
      log(std::string(error.what()) + "; no further screen is recorded");
      failed_ = true;
    }
  }

 private:
  std::string path_;
  std::vector<std::uint8_t> rgb_;
  int number_ = 0;
  bool failed_ = false;
};

ClassicOptions protocol_options(const ClassicSettings& settings) {
  ClassicOptions options{.run_length = settings.truth("run_length_encoding", true),
                         .max_num_frames = settings.number("max_num_frames", 0)};
  const std::string folder = settings.text("record_screen_dir");
  if (!folder.empty())
    options.record = [screens = ScreenFolder(folder)](const Environment& machine) mutable {
      screens.add(machine);
    };
  return options;
}

int run(const std::vector<std::string>& words) {
  if (ClassicSettings::asks_for("--help", words)) {
    std::cout << kUsage << "\n";
    return 0;
  }
  if (ClassicSettings::asks_for("-help", words)) {  // as the classic server
    std::cerr << kUsage << "\n";
    return kExitFailure;
  }
  const ClassicSettings settings(words);
  const bool named = check_controller(settings.text("game_controller"));
  const MachineOptions machine = machine_options(settings);
  const Cartridge cartridge = open_by_name(machine);
  mention_ignored(settings);
  const ClassicOptions protocol = protocol_options(settings);
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
