#include "games/game/property_overrides.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <utility>

using namespace racebeam;
using Catch::Contains;

namespace {

PropertyOverrides overrides_of(std::string_view key, std::string_view value) {
  PropertyOverrides properties;
  properties.set(key, value);
  return properties;
}

// A console of which nothing has its default.
const Properties kOther = {.left = Controller::kPaddles,
                           .right = Controller::kDriving,
                           .format = Format::kPal,
                           .scheme = "F8",
                           .ystart = 30,
                           .height = 220};

}  // namespace

TEST_CASE("each property that is given replaces that of the image, and no other") {
  const auto with = [](auto change) {
    Properties properties = kOther;
    change(properties);
    return properties;
  };
  CHECK(overrides_of("left", "genesis").apply_to(kOther) ==
        with([](auto& p) { p.left = Controller::kGenesis; }));
  CHECK(overrides_of("right", "genesis").apply_to(kOther) ==
        with([](auto& p) { p.right = Controller::kGenesis; }));
  CHECK(overrides_of("format", "secam").apply_to(kOther) == with([](auto& p) { p.format = Format::kSecam; }));
  CHECK(overrides_of("scheme", "E0").apply_to(kOther) == with([](auto& p) { p.scheme = "E0"; }));
  CHECK(overrides_of("scheme", "auto").apply_to(kOther) == with([](auto& p) { p.scheme = ""; }));
  CHECK(overrides_of("ystart", "7").apply_to(kOther) == with([](auto& p) { p.ystart = 7; }));
  CHECK(overrides_of("height", "199").apply_to(kOther) == with([](auto& p) { p.height = 199; }));
  CHECK(PropertyOverrides{}.apply_to(kOther) == kOther);
}

TEST_CASE("properties are empty until one is given") {
  CHECK(PropertyOverrides{}.empty());
  for (const auto& [key, value] : {std::pair("left", "joystick"),
                                   {"right", "none"},
                                   {"format", "auto"},
                                   {"scheme", "auto"},
                                   {"ystart", "0"},
                                   {"height", "210"}}) {
    INFO(key);
    CHECK_FALSE(overrides_of(key, value).empty());
  }
}

TEST_CASE("words are accepted in capitals, too, and a scheme of two words with an underscore") {
  CHECK(overrides_of("left", "Light_Gun").left == Controller::kLightGun);
  CHECK(overrides_of("format", "PAL60").format == Format::kPal60);
  CHECK(overrides_of("scheme", "F8_swapped").scheme == "F8 swapped");
  CHECK(scheme_word("F8 swapped") == "F8_swapped");
}

TEST_CASE("the first line and the height have limits, and so has their sum") {
  for (const char* ystart : {"0", "50"})
    CHECK(overrides_of("ystart", ystart).apply_to({}).ystart == std::stoi(ystart));
  for (const char* height : {"100", "256"})
    CHECK(overrides_of("height", height).apply_to({}).height == std::stoi(height));
  for (const char* ystart : {"-1", "51", "", "x", "3x", " 3", "99999999999"})
    CHECK_THROWS_WITH(overrides_of("ystart", ystart),
                      "ystart is '" + std::string(ystart) + "'; it takes a whole number from 0 to 50");
  for (const char* height : {"99", "257"})
    CHECK_THROWS_WITH(overrides_of("height", height), Contains("it takes a whole number from 100 to 256"));
  CHECK(overrides_of("ystart", "50").apply_to({.height = 250}).ystart == 50);
  CHECK_THROWS_WITH(overrides_of("ystart", "50").apply_to({.height = 251}),
                    "the sum of ystart and height is 301; it must be at most 300");
}

TEST_CASE("an unknown property or value is refused with those that are accepted") {
  CHECK_THROWS_WITH(overrides_of("palette", "x"),
                    "unknown property 'palette' of a cartridge; accepted: scheme, left, right, format, "
                    "height and ystart");
  CHECK_THROWS_WITH(overrides_of("format", "pal50"),
                    "format is 'pal50'; it takes auto, ntsc, pal, pal60, secam");
  CHECK_THROWS_WITH(overrides_of("right", std::string(41, 'x')), Contains("'" + std::string(40, 'x') + "'"));
}
