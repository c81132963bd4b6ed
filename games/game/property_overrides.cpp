#include "games/game/property_overrides.hpp"

#include <algorithm>
#include <charconv>

#include "emulator/cartridge/cartridge.hpp"
#include "system/invalid_input.hpp"
#include "system/words.hpp"

namespace racebeam {
namespace {

constexpr std::string_view kDetected = "auto";

[[noreturn]] void refuse(std::string_view key, std::string_view value, const std::string& accepted) {
  constexpr std::size_t kMaxShown = 40;
  throw InvalidInput(std::string(key) + " is '" + std::string(value.substr(0, kMaxShown)) + "'; it takes " +
                     accepted);
}

template <typename Rows>
auto choice(std::string_view key, std::string_view value, const Rows& rows) {
  const std::string name = lower_case(value);
  std::string accepted;
  for (const auto& row : rows) {
    if (row.name == name) return row.value;
    (accepted += accepted.empty() ? "" : ", ") += row.name;
  }
  refuse(key, value, accepted);
}

int number(std::string_view key, std::string_view value, int least, int most) {
  int number = 0;
  const char* const end = value.data() + value.size();
  const auto [rest, error] = std::from_chars(value.data(), end, number);
  if (error == std::errc{} && rest == end && number >= least && number <= most) return number;
  refuse(key, value, "a whole number from " + std::to_string(least) + " to " + std::to_string(most));
}

std::string_view scheme(std::string_view value) {
  if (value == kDetected) return {};
  std::string name(value);
  std::ranges::replace(name, '_', ' ');
  return scheme_named(name).name;
}

}  // namespace

void PropertyOverrides::set(std::string_view key, std::string_view value) {
  if (key == "scheme") {
    scheme = racebeam::scheme(value);
  } else if (key == "left") {
    left = choice(key, value, kControllers);
  } else if (key == "right") {
    right = choice(key, value, kControllers);
  } else if (key == "format") {
    format = choice(key, value, kFormats);
  } else if (key == "height") {
    height = number(key, value, kMinHeight, kMaxHeight);
  } else if (key == "ystart") {
    ystart = number(key, value, 0, kLastYStart);
  } else {
    throw InvalidInput("unknown property '" + std::string(key) +
                       "' of a cartridge; accepted: scheme, left, right, format, height and ystart");
  }
}

bool PropertyOverrides::empty() const { return !left && !right && !format && !scheme && !ystart && !height; }

Properties PropertyOverrides::apply_to(Properties properties) const {
  properties.left = left.value_or(properties.left);
  properties.right = right.value_or(properties.right);
  properties.format = format.value_or(properties.format);
  properties.scheme = scheme.value_or(properties.scheme);
  properties.ystart = ystart.value_or(properties.ystart);
  properties.height = height.value_or(properties.height);
  const int lines = properties.ystart + properties.height;
  if (lines > kPictureLines)
    throw InvalidInput("the sum of ystart and height is " + std::to_string(lines) + "; it must be at most " +
                       std::to_string(kPictureLines));
  return properties;
}

std::string scheme_word(std::string_view name) {
  std::string word(name);
  std::ranges::replace(word, ' ', '_');
  return word;
}

}  // namespace racebeam
