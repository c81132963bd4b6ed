#include "cli/commands/trace.hpp"

#include <zlib.h>

#include <array>
#include <charconv>
#include <cstdio>
#include <memory>
#include <span>
#include <string>

#include "cli/arguments/actions.hpp"
#include "cli/arguments/options.hpp"
#include "environment/input/has_paddles.hpp"

namespace racebeam {
namespace {

constexpr auto kTraceFooter = R"(The output has these lines:
  R OBSERVATION                        a reset: the first, and one after each end
  A ACTION REWARD OVER OBSERVATION     one act; ACTION is a number, or NUMBER@STRENGTH
  M INDEX VALUE OBSERVATION            a write to RAM
  S LINE SCREEN RGB                    with --screen-of LINE: the line's screen in full, hexadecimal

OBSERVATION is LIVES RAM SCREEN, then the fields of the options, in this order: AUDIO (--audio), TRUNCATED FRAME
EPISODEFRAME (--counters), RGB GREY (--colors; - - in the lines between), RAMHEX (--ram).
RAM, SCREEN, AUDIO, RGB and GREY are CRC-32 checksums (as in zlib): of the 128 bytes of RAM, of the palette
indices of the screen, of the 512 samples, and of the screen in colours and in grey. With --mode or
--difficulty, the game is reset once more before the first line. The output is valid input of --actions.
At an invalid action, the program ends with status 1 and one line that names it.

Examples:
  echo 1 3 3 3 4 | racebeam trace --rom pong.bin --actions -
  racebeam trace --rom pong.bin --actions pong.trace.gz --audio --ram | grep -c '^A')";

struct TraceOptions {
  MachineOptions machine;
  std::string actions;
  bool counters = false;
  int colors = 0;  // every N lines; 0: never
  bool ram = false;
  int screen_of = -1;  // a line's number, from 0
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

void append_number(std::string& out, int number) { out += ' ' + std::to_string(number); }

// Plays the steps, and prints a line for each.
class Tracer {
 public:
  Tracer(const TraceOptions& options, Environment& environment)
      : options_(options), environment_(environment) {}

  void reset() { end_line("R"); }

  void play(const ScriptedStep& step) {
    if (step.write) return write(*step.write);
    const int reward = act(step);
    const bool over = environment_.game_over();
    end_line("A " + name(step) + ' ' + std::to_string(reward) + (over ? " 1" : " 0"));
    if (!over) return;
    environment_.reset_game();
    reset();
  }

  std::string& out() { return out_; }

 private:
  int act(const ScriptedStep& step) {
    try {
      return environment_.act(reference_action(step.action), kNoopB, step.strength);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument("line " + std::to_string(step.line) + " of the actions: " + error.what());
    }
  }

  // The numbers of the console's switches mean nothing to the reference: it refuses them, or with paddles
  // presses nothing.
  int reference_action(int action) const {
    if (!is_of_console(action)) return action;
    if (has_paddles(environment_)) return kReferenceReset;
    throw std::invalid_argument(
        "action " + std::to_string(action) +
        " of player A is out of range; accepted: 0 to 17, and 40 which presses nothing");
  }

  static std::string name(const ScriptedStep& step) {
    if (step.strength == 1) return std::to_string(step.action);
    std::array<char, 32> text;  // the shortest text that gives the same strength again
    const auto end = std::to_chars(text.begin(), text.end(), step.strength).ptr;
    return std::to_string(step.action) + '@' + std::string(text.begin(), end);
  }

  void write(const RamWrite& byte) {
    environment_.set_ram(byte.index, byte.value);
    end_line("M " + std::to_string(byte.index) + ' ' + std::to_string(byte.value));
  }

  void end_line(const std::string& event) {
    out_ += event;
    append_number(out_, environment_.lives());
    append_crc(out_, environment_.ram());
    append_crc(out_, environment_.screen());
    if (environment_.settings().sound) append_crc(out_, environment_.audio());
    if (options_.counters) append_counters();
    if (options_.colors > 0) append_colors();
    if (options_.ram) append_hex(out_ += ' ', environment_.ram());
    out_ += '\n';
    if (line_++ == options_.screen_of) append_screen();
  }

  void append_counters() {
    append_number(out_, environment_.truncated() ? 1 : 0);
    append_number(out_, environment_.frame_number());
    append_number(out_, environment_.episode_frame_number());
  }

  void append_colors() {
    if (line_ % options_.colors != 0) {
      out_ += " - -";
      return;
    }
    environment_.screen_rgb(pixels_);
    append_crc(out_, pixels_);
    environment_.screen_grey(pixels_);
    append_crc(out_, pixels_);
  }

  void append_screen() {
    append_hex(out_ += "S " + std::to_string(options_.screen_of) + ' ', environment_.screen());
    environment_.screen_rgb(pixels_);
    append_hex(out_ += ' ', pixels_);
    out_ += '\n';
  }

  static constexpr int kNoopB = 18;

  const TraceOptions& options_;
  Environment& environment_;
  int line_ = 0;
  std::string out_;
  std::vector<std::uint8_t> pixels_;
};

void write_out(std::string& out) {
  if (std::fwrite(out.data(), 1, out.size(), stdout) != out.size() || std::fflush(stdout) != 0) {
    throw std::runtime_error("cannot write to standard output");
  }
  out.clear();
}

void run(const TraceOptions& options) {
  constexpr std::size_t kEnough = 1 << 16;
  const auto script = read_script(options.actions);
  Environment environment = open_environment(options.machine);
  Tracer tracer(options, environment);
  tracer.reset();
  for (const ScriptedStep& step : script) {
    try {
      tracer.play(step);
    } catch (...) {
      write_out(tracer.out());  // output before the error is valid
      throw;
    }
    if (tracer.out().size() >= kEnough) write_out(tracer.out());
  }
  write_out(tracer.out());
}

}  // namespace

void add_trace(Subcommand& program) {
  const auto options = std::make_shared<TraceOptions>();
  Settings& settings = options->machine.settings;
  settings.random_seed = 123;
  settings.sticky = 0;

  Subcommand command =
      program.add_subcommand("trace", "Play a list of actions and print the result of each", kTraceFooter);
  add_machine_options(command, options->machine);
  command.find("--seed").help("Seed of the sticky actions");
  command
      .option("--actions", options->actions,
              "A file with a trace, or with numbers of actions; plain or gzip; -: standard input")
      .value_name("FILE")
      .required();
  add_count(command, "--max-frames", settings.max_episode_frames, 0,
            "Frames after which an episode is over; 0: no limit");
  command.flag("--truncate-on-life-loss", settings.truncate_on_life_loss,
               "An episode is over when a life is lost");
  command.flag("--audio", settings.sound, "Also print the checksum of the sound");
  command.flag("--counters", options->counters,
               "Also print: truncated, frames since loading, frames of the episode");
  add_count(command, "--colors", options->colors, 0,
            "Also print the checksums of the screen in colours and in grey, every N lines; 0: never");
  add_count(command, "--screen-of", options->screen_of, 0,
            "Also print the screen of this line; the first is 0")
      .default_text("");
  command.flag("--ram", options->ram, "Also print the RAM in full");
  command.runs([options] { run(*options); });
}

}  // namespace racebeam
