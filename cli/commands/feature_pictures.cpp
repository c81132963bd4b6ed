#include "cli/commands/feature_pictures.hpp"

#include <algorithm>
#include <array>

#include "agents/features/object_features.hpp"
#include "agents/features/tile_colours.hpp"
#include "cli/commands/png_file.hpp"
#include "emulator/tia/palette.hpp"

namespace racebeam {
namespace {

constexpr int kSampleScreens = 60, kGridWidth = 16, kGridHeight = 14, kSecamColours = 8;
constexpr int kBand = kFeatureHeight / kMaxClasses;  // rows of a class

constexpr std::array<Rgb, kMaxClasses> kClassColours = {
    Rgb{230, 60, 60},  {60, 200, 80},  {70, 120, 240},  {240, 200, 40}, {200, 80, 220},
    Rgb{60, 210, 210}, {250, 140, 40}, {240, 240, 240}, {150, 110, 70}, {250, 150, 190}};

using Picture = std::vector<Rgb>;  // 160 x 210 pixels

Screen screen_of(const Colours& colours) { return Screen(colours.data(), kFeaturePixels); }

std::size_t pixel_at(int x, int y) {
  return static_cast<std::size_t>(y) * kFeatureWidth + static_cast<std::size_t>(x);
}

void write(const std::string& path, const Picture& picture) {
  std::vector<std::uint8_t> rgb;
  for (const Rgb& colour : picture) rgb.insert(rgb.end(), {colour.r, colour.g, colour.b});
  write_screen(path, rgb);
}

void write(const std::string& path, const Colours& colours, Format format) {
  Picture picture;
  for (const std::uint8_t index : colours) picture.push_back(palette(format)[index & ~1U]);
  write(path, picture);
}

// Returns whether there was room between `left` and the right side.
bool draw_shape(Picture& picture, ShapeView shape, int left, int top, const Rgb& colour) {
  const Box box = box_of(shape);
  if (left + box.width > kFeatureWidth || box.height >= kBand) return false;
  for (const PixelRun& run : shape)
    for (int x = run.first; x <= run.last; ++x) picture[pixel_at(left + x, top + run.row)] = colour;
  return true;
}

}  // namespace

ScreenPair sample_screen(const Cartridge& cartridge, const SampleSettings& settings) {
  ScreenPair screens;
  FeatureScreen features;
  sample_screens(cartridge, settings, kSampleScreens, settings.seed, [&](const Environment& machine, bool) {
    const Screen pixels = features.of(machine);
    screens.before = std::move(screens.last);
    screens.last.assign(pixels.begin(), pixels.end());
  });
  return screens;
}

void draw_background(const std::string& path, const Background& background) {
  Colours indices(background.begin(), background.end());
  for (std::uint8_t& colour : indices) colour = static_cast<std::uint8_t>(colour << 1);
  write(path, indices, Format::kNtsc);
}

void draw_in_secam(const std::string& path, const Colours& screen) {
  Colours indices = screen;
  for (std::uint8_t& index : indices) index = static_cast<std::uint8_t>(secam_of(colour_of(index)) << 1);
  write(path, indices, Format::kSecam);
}

void draw_tiles(const std::string& path, const Background& background, const Colours& screen) {
  const TileColours set(background, kGridWidth, kGridHeight, kSecamColours, false);
  ActiveFeatures active;
  set.extract(screen_of(screen), active);
  std::vector<std::vector<std::uint8_t>> tiles(kGridWidth * kGridHeight);
  for (const std::uint32_t feature : active.indices)
    tiles[feature / kSecamColours].push_back(static_cast<std::uint8_t>(feature % kSecamColours * 2));
  Colours picture(kFeaturePixels);
  for (std::size_t pixel = 0; pixel < picture.size(); ++pixel) {
    const std::size_t x = pixel % kFeatureWidth, y = pixel / kFeatureWidth;
    constexpr std::size_t kWide = kFeatureWidth / kGridWidth, kHigh = kFeatureHeight / kGridHeight;
    const auto& colours = tiles[y / kHigh * kGridWidth + x / kWide];
    if (!colours.empty()) picture[pixel] = colours[x % kWide * colours.size() / kWide];
  }
  write(path, picture, Format::kSecam);
}

void draw_classes(const std::string& path, const ObjectClasses& classes) {
  Picture picture(kFeaturePixels);
  for (std::size_t number = 0; number < classes.size(); ++number) {
    int left = 1;
    for (const Shape& shape : classes[number])
      if (draw_shape(picture, shape, left, static_cast<int>(number) * kBand, kClassColours[number]))
        left += box_of(shape).width + 2;
  }
  write(path, picture);
}

void draw_objects(const std::string& path, const Background& background, const ObjectClasses& classes,
                  const ScreenPair& screens, int reach) {
  Picture picture;
  for (const std::uint8_t index : screens.last) {
    const auto grey = static_cast<std::uint8_t>(grey_table(Format::kNtsc)[index & ~1U] / 2);
    picture.push_back({grey, grey, grey});
  }
  InstanceFinder finder(background, classes, reach);
  finder.find(screen_of(screens.before));
  for (const Instance& instance : finder.find(screen_of(screens.last))) {
    const Box& box = instance.box;
    for (int y = box.top; y < box.top + box.height; ++y)
      for (int x = box.left; x < box.left + box.width; ++x)
        if (colour_of(screens.last[pixel_at(x, y)]) != background[pixel_at(x, y)])
          picture[pixel_at(x, y)] = kClassColours[instance.class_number];
  }
  write(path, picture);
}

}  // namespace racebeam
