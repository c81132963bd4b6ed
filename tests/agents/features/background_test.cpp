#include "agents/features/background.hpp"

#include <catch2/catch.hpp>

#include "agents/base/random.hpp"
#include "agents/features/game_facts.hpp"
#include "system/invalid_input.hpp"
#include "tests/agents/experiment/samples.hpp"

using namespace racebeam;
using namespace racebeam::test;

TEST_CASE("A background under moving sprites comes out exactly") {
  Random random(1);
  Background truth;
  for (auto& colour : truth) colour = static_cast<std::uint8_t>(random.below(kColours));
  ColourHistogram histogram;
  for (int count = 0; count < 300; ++count) {
    std::array<std::uint8_t, kFeaturePixels> screen;
    for (std::size_t pixel = 0; pixel < screen.size(); ++pixel)
      screen[pixel] = static_cast<std::uint8_t>(truth[pixel] << 1);
    for (int sprite = 0; sprite < 6; ++sprite) {
      const std::size_t left = random.below(kFeatureWidth - 8), top = random.below(kFeatureHeight - 8);
      for (std::size_t y = top; y < top + 8; ++y)
        for (std::size_t x = left; x < left + 8; ++x) screen[y * kFeatureWidth + x] = 0x42;
    }
    histogram.add(screen);
  }
  CHECK(histogram.most_frequent() == truth);
}

TEST_CASE("Of colours that are as frequent, the lowest is the background") {
  ColourHistogram histogram;
  std::array<std::uint8_t, kFeaturePixels> screen;
  for (const int colour : {9, 4, 9, 4}) {
    screen.fill(static_cast<std::uint8_t>(colour << 1));
    histogram.add(screen);
  }
  CHECK(histogram.most_frequent()[0] == 4);
}

TEST_CASE("A background is the same again, as CSV and as a file") {
  const SampleSettings settings{1, 500, 500, short_episodes()};
  const Background background = discover_background(beamfall(), settings);
  CHECK(discover_background(beamfall(), settings) == background);
  CHECK(background_of_csv("a.csv", csv_of(background)) == background);
  const Scratch folder;
  const std::string path = folder.path("a.background");
  write(path, bytes_of(background, beamfall(), settings));
  CHECK(background_of(path, beamfall(), settings) == background);
  SampleSettings other = settings;
  other.seed = 2;
  CHECK_THROWS_WITH(background_of(path, beamfall(), other), path + ": seed is '1'; expected '2'");
  Background wrong = background;
  wrong.front() = kColours;
  write(path, bytes_of(wrong, beamfall(), settings));
  CHECK_THROWS_WITH(background_of(path, beamfall(), settings), Catch::Contains("colours from 0 to 127"));
}

TEST_CASE("A background of another size is refused") {
  const std::string good = csv_of(Background{});
  const auto refusal = [](const std::string& text) {
    try {
      background_of_csv("a.csv", text);
    } catch (const InvalidInput& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(refusal(good) == "");
  CHECK(refusal("") == "a.csv: it has 0 lines; accepted: 210");
  CHECK(refusal(good + good) == "a.csv:211: there are more than 210 lines");
  CHECK(refusal("0," + good) == "a.csv:1: it does not have 160 colours");
  CHECK(refusal(good.substr(2)) == "a.csv:1: it does not have 160 colours");
  CHECK(refusal("128" + good.substr(1)) ==
        "a.csv:1: '128' is not a colour; accepted: 160 numbers from 0 to 127, with commas between");
  CHECK(refusal("x" + good.substr(1)).starts_with("a.csv:1: 'x' is not a colour"));
}

TEST_CASE("Screens are those of random play, as many as were asked for") {
  int count = 0;
  sample_screens(beamfall(), {1, 1, 1, short_episodes(2000)}, 1500, 4, [&](const Environment& machine, bool) {
    ++count;
    REQUIRE(machine.screen().size() == kFeaturePixels);
  });
  CHECK(count == 1500);
}

TEST_CASE("Samples depend on nothing that the file of a background does not name") {
  const SampleSettings settings{1, 500, 500, short_episodes()};
  const auto samples = [](const SampleSettings& of) {
    std::vector<std::uint64_t> states;
    sample_screens(beamfall(), of, 700, of.seed,
                   [&](const Environment& machine, bool) { states.push_back(machine.state_hash()); });
    return states;
  };
  const auto file = [](const SampleSettings& of) { return bytes_of(Background{}, beamfall(), of); };
  using Change = std::function<void(SampleSettings&)>;
  const Change change =
      GENERATE(Change([](SampleSettings& of) { of.play.machine.sticky = 0.25F; }),
               Change([](SampleSettings& of) { of.play.machine.max_episode_frames = 300; }),
               Change([](SampleSettings& of) { of.play.machine.system_seed = 7; }),
               Change([](SampleSettings& of) { of.play.machine.truncate_on_life_loss = true; }),
               Change([](SampleSettings& of) { of.play.machine.frame_skip = 4; }),
               Change([](SampleSettings& of) { of.play.machine.color_averaging = true; }),
               Change([](SampleSettings& of) { of.play.mode = 0; }),
               Change([](SampleSettings& of) { of.play.difficulty = 0; }),
               Change([](SampleSettings& of) { of.seed = 2; }));
  SampleSettings other = settings;
  change(other);
  CHECK((samples(other) == samples(settings) || file(other) != file(settings)));
}

TEST_CASE("A background of another version is refused") {
  SampleSettings settings{1, 500, 500, short_episodes()};
  settings.version = "0.0.9";
  const Scratch folder;
  const std::string path = folder.path("a.background");
  write(path, bytes_of(Background{}, beamfall(), settings));
  settings.version = "0.1.0";
  CHECK_THROWS_WITH(background_of(path, beamfall(), settings),
                    path + ": version is '0.0.9'; expected '0.1.0'");
}
