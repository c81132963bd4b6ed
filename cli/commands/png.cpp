#include "cli/commands/png.hpp"

#include <algorithm>
#include <charconv>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "cli/arguments/subcommand.hpp"
#include "cli/commands/png_file.hpp"
#include "cli/connect/reply_picture.hpp"
#include "emulator/tia/palette.hpp"
#include "games/game/property_overrides.hpp"

namespace racebeam {
namespace {

constexpr auto kPngFooter =
    R"(Reads replies of the line protocol from standard input, and writes the picture of the last one that has any: a
field screen, rgb, grey, or of another size such as grey84x84x4, whose screens are one below the other; or the data
of `shot`. The encoding is the one that fits. With --encoding delta, it must have the replies from that of `load`
or `observe` on. The pixels of whole screens are doubled, to a width of 320.

A line that is neither ok nor an error belongs to the classic protocol, or is only its field with the screen. It
does not contain its format: give --full if the server was started with --full-screen.

The colours of the field screen are those of the field palette, else those of the standard that the reply of `load`
says. Neither is in a single line: give --palette.

Examples:
  printf 'load beamfall\nact FIRE*60\nlook screen\n' | racebeam serve --stdio | racebeam png now.png
  printf '1,0,0,1\n3,18\n' | racebeam serve --classic --stdio --rom builtin:beamfall |
    sed -n 3p | racebeam png now.png)";

constexpr std::size_t kRamDigits = 256;
constexpr std::size_t kWidth = 160;
constexpr std::size_t kMaxPixels = kWidth * 1024;
const std::vector<std::string> kEncodings = {"hex", "rle", "delta", "base64", "zlib", "raw"};

struct PngOptions {
  std::string path;
  std::string palette;  // empty: as the replies say
  PictureRequest request;
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

// The picture of a line of the classic protocol.
ReplyPicture classic_picture(std::string_view line, bool full) {
  ReplyPicture picture;
  picture.bytes = bytes_of(screen_field(line));
  if (!full) picture.bytes = expand(picture.bytes);
  const std::size_t pixels = picture.bytes.size();
  if (pixels == 0 || pixels % kWidth != 0 || pixels > kMaxPixels) {
    throw std::invalid_argument("the screen has " + std::to_string(pixels) +
                                " pixels, not whole rows of 160; it may be " +
                                (full ? "in run lengths (without --full)" : "a full screen (--full)"));
  }
  picture.width = kWidth;
  return picture;
}

Format format_named(const std::string& name) {
  const auto found = std::ranges::find(kFormats, name, &WordFor<Format>::name);
  return found == kFormats.end() ? Format::kNtsc : found->value;
}

// The colours of the values of the field screen.
Palette colors_of(const ReplyPicture& picture, const std::string& named) {
  if (!named.empty() || picture.palette.empty())
    return palette(format_named(named.empty() ? picture.format : named));
  Palette colors;
  for (std::size_t i = 0; i < colors.size(); ++i)
    colors[i] = {picture.palette[3 * i], picture.palette[3 * i + 1], picture.palette[3 * i + 2]};
  return colors;
}

std::vector<std::uint8_t> colored(const ReplyPicture& picture, const std::string& named) {
  if (picture.pixels == ReplyPicture::Pixels::kRgb) return picture.bytes;
  const bool grey = picture.pixels == ReplyPicture::Pixels::kGrey;
  const Palette colors = colors_of(picture, named);
  std::vector<std::uint8_t> rgb;
  rgb.reserve(picture.bytes.size() * 3);
  for (const std::uint8_t pixel : picture.bytes) {
    const Rgb color = grey ? Rgb{pixel, pixel, pixel} : colors[pixel];
    rgb.insert(rgb.end(), {color.r, color.g, color.b});
  }
  return rgb;
}

ReplyPicture read_picture(const PngOptions& options) {
  std::string line;
  std::getline(std::cin, line);
  if (line.ends_with('\r')) line.pop_back();
  return is_reply(line) ? last_picture(std::move(line), std::cin, options.request)
                        : classic_picture(line, options.full);
}

void run(const PngOptions& options) {
  const ReplyPicture picture = read_picture(options);
  if (picture.pixels == ReplyPicture::Pixels::kFile) return write_picture_file(options.path, picture.bytes);
  const auto rgb = colored(picture, options.palette);
  picture.resized ? write_png(options.path, rgb, picture.width) : write_screen(options.path, rgb);
}

}  // namespace

void add_png(Subcommand& program) {
  const auto options = std::make_shared<PngOptions>();
  Subcommand command =
      program.add_subcommand("png", "Convert a screen that a client received to a PNG file", kPngFooter);
  command.option("OUT.png", options->path, "The file to write").required();
  command
      .option("--palette", options->palette, "ntsc, pal or secam; without it, what the replies say, or ntsc")
      .check(one_of({"ntsc", "pal", "secam"}))
      .value_name("NAME");
  command.option("--field", options->request.field, "The field to show; without it, the first picture")
      .value_name("NAME");
  command.option("--encoding", options->request.encoding, "hex, rle, delta, base64, zlib or raw")
      .check(one_of(kEncodings))
      .value_name("NAME");
  command.option("--machine", options->request.machine, "The machine of open to show, 0 the first")
      .check(whole_number(0, 1 << 20));
  const Option run_lengths =
      command.flag("--rle", options->run_lengths, "Of a classic line: run lengths, as usual");
  command.flag("--full", options->full, "Of a classic line: two digits a pixel").excludes(run_lengths);
  command.runs([options] { run(*options); });
}

}  // namespace racebeam
