#include "cli/commands/png.hpp"

#include <algorithm>
#include <charconv>
#include <iostream>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "cli/arguments/subcommand.hpp"
#include "cli/commands/png_file.hpp"
#include "emulator/tia/palette.hpp"

namespace racebeam {
namespace {

constexpr auto kPngFooter =
    R"(Reads one line of the classic protocol from standard input, or only its field with the screen, and writes the
picture: 320 pixels wide, because every pixel is doubled. The line does not contain its format: give --full if
the server was started with --full-screen, and --palette for the game's television standard.

Example:
  printf '1,0,0,1\n3,18\n' | racebeam serve --classic --stdio --rom builtin:beamfall |
    sed -n 3p | racebeam png now.png)";

constexpr std::size_t kWidth = 160;
constexpr std::size_t kRamDigits = 256;
constexpr std::size_t kMostPixels = kWidth * 1024;

struct PngOptions {
  std::string path;
  Format format = Format::kNtsc;
  bool run_lengths = false;  // the default; the flag makes it explicit
  bool full = false;
};

// Each field of a line has a colon after it. RAM is the field of 256 digits (a screen is never that short),
// and the episode is the one with a comma.
std::string_view screen_field(std::string_view line) {
  while (!line.empty()) {
    const std::string_view field = line.substr(0, line.find(':'));
    if (!field.empty() && field.size() != kRamDigits && field.find(',') == field.npos) return field;
    line.remove_prefix(std::min(line.size(), field.size() + 1));
  }
  throw std::invalid_argument(
      "the line on standard input contains no screen; request it with the flags 1,0,0,1");
}

std::vector<std::uint8_t> bytes_of(std::string_view digits) {
  if (digits.size() % 2 != 0)
    throw std::invalid_argument("the screen has an odd number of digits; the line may be truncated");
  std::vector<std::uint8_t> bytes(digits.size() / 2);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const char* pair = digits.data() + 2 * i;
    const auto [end, error] = std::from_chars(pair, pair + 2, bytes[i], 16);
    if (error != std::errc{} || end != pair + 2) {
      throw std::invalid_argument("'" + std::string{pair, 2} + "' in the screen is not a hexadecimal byte");
    }
  }
  return bytes;
}

std::vector<std::uint8_t> expand(const std::vector<std::uint8_t>& runs) {
  if (runs.size() % 2 != 0)
    throw std::invalid_argument("the last run of the screen has no length; the line may be truncated");
  std::vector<std::uint8_t> pixels;
  for (std::size_t i = 0; i < runs.size(); i += 2) pixels.insert(pixels.end(), runs[i + 1], runs[i]);
  return pixels;
}

std::vector<std::uint8_t> decode(std::string_view line, bool full) {
  auto pixels = bytes_of(screen_field(line));
  if (!full) pixels = expand(pixels);
  if (pixels.empty() || pixels.size() % kWidth != 0 || pixels.size() > kMostPixels) {
    throw std::invalid_argument("the screen has " + std::to_string(pixels.size()) +
                                " pixels, not whole rows of 160; it may be " +
                                (full ? "in run lengths (without --full)" : "a full screen (--full)"));
  }
  return pixels;
}

std::vector<std::uint8_t> colored(const std::vector<std::uint8_t>& pixels, const Palette& colors) {
  std::vector<std::uint8_t> rgb;
  rgb.reserve(pixels.size() * 3);
  for (const std::uint8_t pixel : pixels)
    rgb.insert(rgb.end(), {colors[pixel].r, colors[pixel].g, colors[pixel].b});
  return rgb;
}

void run(const PngOptions& options) {
  std::string line;
  std::getline(std::cin, line);
  if (line.ends_with('\r')) line.pop_back();
  write_png(options.path, colored(decode(line, options.full), palette(options.format)));
}

}  // namespace

void add_png(Subcommand& program) {
  const auto options = std::make_shared<PngOptions>();
  Subcommand command =
      program.add_subcommand("png", "Convert a screen that a client received to a PNG file", kPngFooter);
  command.option("OUT.png", options->path, "The file to write").required();
  command.choice<Format>("--palette", options->format,
                         {{"ntsc", Format::kNtsc}, {"pal", Format::kPal}, {"secam", Format::kSecam}}, "ntsc",
                         "ntsc, pal or secam");
  const Option run_lengths =
      command.flag("--rle", options->run_lengths, "The screen is in run lengths, as usual");
  command.flag("--full", options->full, "The screen is full: two digits a pixel").excludes(run_lengths);
  command.runs([options] { run(*options); });
}

}  // namespace racebeam
