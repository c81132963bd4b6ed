#include "cli/trace.hpp"

#include <zlib.h>

#include <cstdio>
#include <memory>
#include <span>
#include <string>

#include "cli/actions.hpp"
#include "cli/options.hpp"

namespace racebeam {
namespace {

constexpr auto kFooter = R"(Lines printed:
  R LIVES RAM SCREEN [AUDIO] [RAMHEX]                      after a reset: the first, and one after each end
  A ACTION REWARD OVER LIVES RAM SCREEN [AUDIO] [RAMHEX]   after one act

RAM, SCREEN and AUDIO are CRC-32 (as in zlib) of the 128 bytes of RAM, of the palette indices of the screen
and of the 512 samples. With --mode or --difficulty the game is reset once more before the first line.

Examples:
  echo 1 3 3 3 4 | racebeam trace --rom pong.bin --actions -
  racebeam trace --rom pong.bin --actions pong.trace.gz --audio --ram | grep -c '^A'

What can't be played ends the program with status 1 and one line that names it.)";

struct TraceOptions {
  MachineOptions machine;
  std::string actions;
  bool ram = false;
};

void append_hex(std::string& out, std::span<const std::uint8_t> bytes) {
  constexpr char kDigits[] = "0123456789abcdef";
  for (const std::uint8_t byte : bytes) out.append({kDigits[byte >> 4], kDigits[byte & 15]});
}

void append_crc(std::string& out, std::span<const std::uint8_t> bytes) {
  const auto crc = static_cast<std::uint32_t>(crc32(0, bytes.data(), static_cast<uInt>(bytes.size())));
  const std::uint8_t big_endian[] = {static_cast<std::uint8_t>(crc >> 24),
                                     static_cast<std::uint8_t>(crc >> 16),
                                     static_cast<std::uint8_t>(crc >> 8), static_cast<std::uint8_t>(crc)};
  out += ' ';
  append_hex(out, big_endian);
}

void append_observation(std::string& out, const Environment& environment, bool ram) {
  out += ' ' + std::to_string(environment.lives());
  append_crc(out, environment.ram());
  append_crc(out, environment.screen());
  if (environment.settings().sound) append_crc(out, environment.audio());
  if (ram) append_hex(out += ' ', environment.ram());
  out += '\n';
}

int act(Environment& environment, const ScriptedAction& step) {
  try {
    return environment.act(step.action);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("line " + std::to_string(step.line) + " of the actions: " + error.what());
  }
}

void append_act(std::string& out, Environment& environment, const ScriptedAction& step, bool ram) {
  const int reward = act(environment, step);
  const bool over = environment.game_over();
  out += "A " + std::to_string(step.action) + ' ' + std::to_string(reward) + (over ? " 1" : " 0");
  append_observation(out, environment, ram);
  if (!over) return;
  environment.reset_game();
  append_observation(out += 'R', environment, ram);
}

void write_out(std::string& out) {
  if (std::fwrite(out.data(), 1, out.size(), stdout) != out.size() || std::fflush(stdout) != 0) {
    throw std::runtime_error("can't write to standard output");
  }
  out.clear();
}

void run(const TraceOptions& options) {
  constexpr std::size_t kEnough = 1 << 16;
  const auto actions = read_actions(options.actions);
  Environment environment = open_environment(options.machine);
  std::string out = "R";
  append_observation(out, environment, options.ram);
  for (const ScriptedAction& step : actions) {
    try {
      append_act(out, environment, step, options.ram);
    } catch (...) {
      write_out(out);  // what came before the fault is true
      throw;
    }
    if (out.size() >= kEnough) write_out(out);
  }
  write_out(out);
}

}  // namespace

void add_trace(CLI::App& app) {
  const auto options = std::make_shared<TraceOptions>();
  Settings& settings = options->machine.settings;
  settings.random_seed = 123;
  settings.sticky = 0;

  CLI::App& command = *app.add_subcommand("trace", "Play a list of actions and print what each led to");
  add_machine_options(command, options->machine);
  command.get_option("--seed")->description("Seed of all that is random in play");
  command
      .add_option("--actions", options->actions,
                  "A trace, or numbers of actions; plain or gzip; -: standard input")
      ->required();
  add_count(command, "--max-frames", settings.max_episode_frames, 0,
            "Frames after which an episode is over; 0: no limit");
  command.add_flag("--audio", settings.sound, "Print the checksum of the sound too");
  command.add_flag("--ram", options->ram, "Print the RAM in full too");
  command.footer(kFooter);
  command.callback([options] { run(*options); });
}

}  // namespace racebeam
