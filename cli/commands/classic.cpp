#include "cli/commands/classic.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <iostream>

#include "cli/arguments/options.hpp"
#include "cli/commands/classic_settings.hpp"
#include "cli/commands/png_file.hpp"
#include "games/catalogue.hpp"
#include "server/connections/rl_glue_connection.hpp"
#include "server/operation/log.hpp"
#include "server/server.hpp"
#include "system/program/sockets.hpp"
#include "system/words.hpp"

namespace racebeam {
namespace {

constexpr auto kAbout = "Serve with the command line of ALE 0.4 to 0.6, for old launchers";

constexpr auto kUsage = R"(
Usage: racebeam classic -game_controller fifo|fifo_named|rlglue [-key value]... IMAGE

Options:
  -game_controller NAME              fifo: standard streams;
                                     fifo_named: the pipes ale_fifo_out and ale_fifo_in;
                                     rlglue: an RL-Glue core at 127.0.0.1, port RLGLUE_PORT (4096)
  -random_seed N                     0 or time: drawn from the clock
  -run_length_encoding true|false    whether screens are written in run lengths (true)
  -frame_skip N                      frames of an action (1)
  -repeat_action_probability P       probability that a frame repeats the previous action (0.25)
  -max_num_frames N                  frames after which the session ends (0: no limit)
  -max_num_frames_per_episode N      frames after which an episode ends (0: no limit)
  -color_averaging true|false        blend each picture with the previous one (false)
  -record_screen_dir FOLDER          write the screen before each frame to 000000.png and so on
  -restricted_action_set true|false  with rlglue: only the actions that the game uses (false)
  -send_rgb true|false               with rlglue: observations have colours, not indices (false)
  -config FILE                       lines of key = value, which override the command line

Other keys are ignored. ale.cfg in the working directory is read first. The image's file name
selects the game, such as pong.bin; an image with another name is recognised by its MD5. A program
that is called as ale or racebeam-ale behaves as racebeam classic.)";

// Keys that need a window or a sound card.
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

// The game that has the file's stem as its name, whatever the image; else the game of the image's MD5.
Cartridge open_by_name(const MachineOptions& machine) {
  const auto image = load_image(machine.rom);
  auto game = find_game(image->stem);
  if (!game) game = find_game_by_md5(image->md5);
  if (!game)
    throw std::invalid_argument("unknown game '" + image->stem + "', the name of the file " + machine.rom +
                                ", and unknown MD5 " + image->md5 + "; give the file the name of its game");
  const Cartridge cartridge{image, game};
  power_on(cartridge, machine);  // invalid settings must fail before any other output
  if (!game->accepts(image->md5)) log("the MD5 of " + machine.rom + " is not one known for " + game->name);
  return cartridge;
}

void check_controller(const std::string& name) {
  if (name == "fifo_named" && !has_local_channels())
    throw std::invalid_argument(
        "-game_controller 'fifo_named' needs named pipes, which Windows lacks; accepted: fifo and rlglue");
  if (name == "fifo" || name == "fifo_named" || name == "rlglue") return;
  throw std::invalid_argument("-game_controller '" + name +
                              "' is not supported; accepted: fifo, fifo_named and rlglue");
}

// The screens of one session, numbered from 000000.png on, as ALE 0.6 writes them. An existing file is
// overwritten. If the folder cannot be written to, the pictures are lost, but the session continues.
class ScreenFolder {
 public:
  explicit ScreenFolder(std::string path) : path_(std::move(path)) {}

  void add(const Environment& machine) {
    if (failed_) return;
    std::array<char, 24> name{};
    std::snprintf(name.data(), name.size(), "/%06d.png", number_++);
    machine.screen_rgb(rgb_);
    try {
      write_screen(path_ + name.data(), rgb_);
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

std::uint16_t rl_glue_port() {
  const char* const text = std::getenv("RLGLUE_PORT");
  if (text == nullptr || *text == '\0') return kRlGluePort;
  const auto port = parse_number<std::uint16_t>(text);
  if (port && *port > 0) return *port;
  throw std::invalid_argument("RLGLUE_PORT is '" + std::string(text) +
                              "'; it takes the number of a port, from 1 to 65535");
}

int serve_rl_glue(const ClassicSettings& settings, const MachineOptions& machine,
                  const Cartridge& cartridge) {
  Environment environment = power_on(cartridge, machine);
  log("session: " + describe(environment));
  RlGlueEnvironment session(environment, {.rgb = settings.truth("send_rgb", false),
                                          .minimal_actions = settings.truth("restricted_action_set", false),
                                          .max_num_frames = settings.number("max_num_frames", 0)});
  serve_rl_glue(rl_glue_port(), session);
  return 0;
}

int serve_lines(const ClassicSettings& settings, const MachineOptions& machine, const Cartridge& cartridge) {
  const bool named = settings.text("game_controller") == "fifo_named";
  const ClassicService service{[&](Pace* pace) { return power_on(cartridge, machine, pace); },
                               protocol_options(settings), nullptr};
  ServerSettings server;
  server.endpoints.push_back({named ? Address(AlePipes{}) : Address(StandardStreams{}), true});
  Services services;
  services.classic = service;
  return serve(server, services);
}

int run(const std::vector<std::string>& words) {
  if (ClassicSettings::asks_for("--help", words)) {
    std::cout << kAbout << kUsage << "\n";
    return 0;
  }
  if (ClassicSettings::asks_for("-help", words)) {  // as the classic server does
    std::cerr << kAbout << kUsage << "\n";
    return kExitFailure;
  }
  const ClassicSettings settings(words);
  const std::string controller = settings.text("game_controller");
  check_controller(controller);
  const MachineOptions machine = machine_options(settings);
  const Cartridge cartridge = open_by_name(machine);
  mention_ignored(settings);
  return controller == "rlglue" ? serve_rl_glue(settings, machine, cartridge)
                                : serve_lines(settings, machine, cartridge);
}

}  // namespace

void add_classic(Subcommand& program) {
  Subcommand command = program.add_subcommand("classic", kAbout, "");
  command.takes_all_words();
  command.exits_with([command] { return run(command.words()); });
}

}  // namespace racebeam
