#include "agents/features/background.hpp"

#include <algorithm>

#include "agents/base/episode_start.hpp"
#include "agents/base/random.hpp"
#include "system/invalid_input.hpp"
#include "system/words.hpp"

namespace racebeam {
namespace {

constexpr std::size_t kMaxDecisionsBefore = 600, kDecisionsAfter = 600;
constexpr double kPerturb = 0.95;

Settings machine_of_samples(const Settings& requested) {
  Settings machine;
  machine.frame_skip = requested.frame_skip;
  machine.color_averaging = requested.color_averaging;
  machine.cpu = requested.cpu;
  machine.sticky = 0;
  return machine;
}

}  // namespace

void sample_screens(const Cartridge& cartridge, const SampleSettings& settings, int screens,
                    std::uint64_t seed, const LookAtScreen& look) {
  Random random(seed);
  Environment machine(cartridge.image, cartridge.game, machine_of_samples(settings.play.machine));
  PlaySettings play = settings.play;
  play.noop_max = 0;
  const auto any = [&] { return static_cast<int>(random.below(kActions)); };
  int count = 0;
  while (count < screens) {
    begin_episode(machine, play, static_cast<std::uint32_t>(random.next()) | 1U);
    machine.set_drawing(Drawing::kNone);
    const int fixed = any();
    for (std::size_t remaining = random.below(kMaxDecisionsBefore); remaining > 0 && !machine.game_over();
         --remaining)
      machine.act(random.uniform() < kPerturb ? fixed : any());
    machine.set_drawing(Drawing::kLast);
    for (std::size_t remaining = kDecisionsAfter; remaining > 0 && count < screens; --remaining, ++count) {
      machine.act(any());
      look(machine, remaining == kDecisionsAfter);
      if (machine.game_over()) {
        ++count;
        break;
      }
    }
  }
}

ColourHistogram::ColourHistogram() : counts_(kFeaturePixels * kColours) {}

void ColourHistogram::add(Screen screen) {
  for (std::size_t pixel = 0; pixel < screen.size(); ++pixel)
    ++counts_[pixel * kColours + colour_of(screen[pixel])];
}

Background ColourHistogram::most_frequent() const {
  Background background;
  for (std::size_t pixel = 0; pixel < background.size(); ++pixel) {
    const auto first = counts_.begin() + static_cast<std::ptrdiff_t>(pixel * kColours);
    background[pixel] = static_cast<std::uint8_t>(std::max_element(first, first + kColours) - first);
  }
  return background;
}

Background discover_background(const Cartridge& cartridge, const SampleSettings& settings) {
  ColourHistogram histogram;
  FeatureScreen screen;
  sample_screens(cartridge, settings, settings.background_screens, settings.seed,
                 [&](const Environment& machine, bool) { histogram.add(screen.of(machine)); });
  return histogram.most_frequent();
}

Background background_of_csv(const std::string& name, std::string_view text) {
  Background background;
  std::size_t line = 0;
  for (; !text.empty(); ++line) {
    std::string_view row = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(row.size() + 1, text.size()));
    const auto refuse = [&](const std::string& reason) {
      throw InvalidInput(name + ":" + std::to_string(line + 1) + ": " + reason);
    };
    if (line == kFeatureHeight) refuse("there are more than 210 lines");
    for (std::size_t column = 0; column < kFeatureWidth; ++column) {
      const std::string_view value = row.substr(0, row.find(','));
      const auto number = parse_number<int>(value);
      if (!number || *number < 0 || *number >= kColours)
        refuse(quote(value) + " is not a colour; accepted: 160 numbers from 0 to 127, with commas between");
      background[line * kFeatureWidth + column] = static_cast<std::uint8_t>(*number);
      const bool last = column + 1 == kFeatureWidth;
      if (last != (value.size() == row.size())) refuse("it does not have 160 colours");
      row.remove_prefix(std::min(value.size() + 1, row.size()));
    }
  }
  if (line != kFeatureHeight)
    throw InvalidInput(name + ": it has " + std::to_string(line) + " lines; accepted: 210");
  return background;
}

std::string csv_of(const Background& background) {
  std::string text;
  for (std::size_t pixel = 0; pixel < background.size(); ++pixel) {
    append_number(text, std::int64_t{background[pixel]});
    text += (pixel + 1) % kFeatureWidth == 0 ? '\n' : ',';
  }
  return text;
}

}  // namespace racebeam
