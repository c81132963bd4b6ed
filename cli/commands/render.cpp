#include "cli/commands/render.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>

#include "agents/experiment/play.hpp"
#include "cli/arguments/image_options.hpp"
#include "cli/arguments/subcommand.hpp"
#include "emulator/tia/sound.hpp"
#include "recording/episode_log.hpp"
#include "recording/footage.hpp"
#include "recording/media.hpp"
#include "system/input_file.hpp"
#include "system/invalid_input.hpp"
#include "system/printable.hpp"
#include "system/program/signals.hpp"

namespace racebeam {
namespace {

namespace fs = std::filesystem;

constexpr auto kRenderFooter =
    R"(Replays the episode of a log (docs/episodes.md), and writes its pictures or its sound. The extension of FILE selects the
form:
  .gif          an animation of every second frame, without sound
  .y4m          a video, 4:4:4, uncompressed, without sound
  .wav          the sound
  .webm, .mp4   a video with sound, made by ffmpeg, which must be installed
  otherwise     a folder of PNGs: 000000.png and so on

An existing file is never replaced. If the replay has another score than the log, nothing is written; racebeam verify
says more. After SIGINT, SIGTERM or SIGHUP, no unfinished file is left.

Examples:
  racebeam render results/logs/beamfall-random-1/1.episode --to episode.gif
  racebeam render pong.episode --roms ~/atari --to pong.webm)";

struct RenderOptions {
  std::string log, to;
  ImageOptions images;
};

// Writes the frames of a machine.
class Film {
 public:
  // `path` is without its ending.
  Film(const fs::path& path, MediaKind kind, const Environment& machine)
      : media_(make_media(kind, path.has_parent_path() ? path.parent_path().string() : ".",
                          path.filename().string(), footage_of(machine), budget_)) {}

  void add(const Environment& machine) {
    std::array<std::uint8_t, kSamplesPerBlock> samples;
    sound_.registers = machine.sound().registers;
    sound_.generate(samples);
    media_->sound(samples);
    media_->frame(machine.screen());
    ++frames_;
  }

  void commit() { media_->commit(); }

  std::int64_t frames() const { return frames_; }

 private:
  DiskBudget budget_{std::numeric_limits<std::size_t>::max(), Interruption::flag()};
  std::unique_ptr<Media> media_;
  Sound sound_;  // a copy, which does not change the machine's
  std::int64_t frames_ = 0;
};

Cartridge cartridge_of(const EpisodeLog& log, const Images& images) {
  const Cartridge* const found = images.find(log.image_md5);
  if (!found) throw InvalidInput("no image with MD5 " + log.image_md5 + " is here; --roms names its folder");
  auto game = found->game->name == log.game ? found->game : find_game(log.game);
  if (!game) throw InvalidInput("the log is of the game '" + log.game + "', which is not in the catalogue");
  return {found->image, game};
}

// Plays the log, and writes the frames to `path`. Returns their number.
std::int64_t film(const EpisodeLog& log, const RenderOptions& options, const fs::path& path, MediaKind kind) {
  const Interruption interruption;  // ends after the film, which removes its temporary file
  PlaySettings settings = settings_of(log);
  settings.machine.cpu = options.images.cpu;
  Stage stage(cartridge_of(log, images_of(options.images)), settings, Drawing::kEvery);
  stage.begin(settings.machine.random_seed);
  Environment& machine = stage.machine();
  Film film(path, kind, machine);
  machine.watch([&] {
    interruption.check();
    film.add(machine);
  });
  std::int64_t score = 0;
  for (std::size_t i = 0; i < log.actions.size(); ++i) {
    if (machine.game_over()) break;
    machine.act({.a = log.actions[i], .strength_a = log.strength(i)});
    score += machine.raw_rewards().a;
  }
  machine.watch({});
  if (score != log.end.score || machine.state_hash() != log.hashes.back()) {
    throw InvalidInput("the log has the score " + std::to_string(log.end.score) + ", but the machine gives " +
                       std::to_string(score) + ", or another state at the end");
  }
  film.commit();
  return film.frames();
}

// Says the whole path; what writes the file knows only its name.
void check_place(const fs::path& path) {
  if (fs::exists(path)) throw InvalidInput(path.string() + " exists; no file is replaced");
  const fs::path folder = path.parent_path();
  if (!folder.empty() && !fs::is_directory(folder))
    throw InvalidInput("cannot make " + path.string() + ": the folder does not exist: " + folder.string());
}

void run(const RenderOptions& options) {
  const std::string bytes = read_input_file("episode log", options.log, kMaxLogBytes);
  const EpisodeLog log = log_of(fs::path(options.log).filename().string(), bytes);
  if (options.to.empty())
    throw UsageError("--to: '' names no file; accepted: a new file such as a.gif, or a new folder");
  fs::path to = options.to;
  if (!to.has_filename()) to = to.parent_path();  // NAME/
  check_place(to);
  if (const std::string name = to.filename().string(); name[0] == '.' && media_kind(name.substr(1)))
    throw UsageError("--to: '" + options.to + "' is only an extension; accepted: names such as a" + name);
  const std::string ending = to.extension().string();
  const auto kind = ending.empty() ? MediaKind::kPng : media_kind(ending.substr(1));
  if (!kind || ending == ".png") {
    throw UsageError("--to: '" + options.to +
                     "' has an unknown ending; accepted: .gif, .y4m, .wav, .webm, .mp4, and none "
                     "for a folder of PNGs");
  }
  const std::int64_t frames = film(log, options, to.replace_extension(), *kind);
  std::cout << printable(options.to) << ": " << frames << " frames\n";
}

}  // namespace

void add_render(Subcommand& program) {
  const auto options = std::make_shared<RenderOptions>();
  Subcommand command =
      program.add_subcommand("render", "Make a film or pictures of a recorded episode", kRenderFooter);
  command.option("LOG", options->log, "The log of the episode").required();
  command.option("--to", options->to, "The film, or the folder of pictures").value_name("FILE").required();
  add_image_options(command, options->images);
  command.runs([options] { run(*options); });
}

}  // namespace racebeam
