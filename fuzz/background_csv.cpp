// The CSV file of a game's background. The first two words select a part of a valid file, which the rest of
// the input replaces: where it begins, and its size.
#include <string>

#include "agents/features/background.hpp"
#include "fuzz/support/target.hpp"
#include "system/invalid_input.hpp"

namespace racebeam::fuzz {
namespace {

std::string valid_file() {
  Background background{};
  for (std::size_t pixel = 0; pixel < background.size(); ++pixel)
    background[pixel] = static_cast<std::uint8_t>(pixel * 7 % 128);
  return csv_of(background);
}

}  // namespace

void run(Bytes input) {
  static const std::string valid = valid_file();
  Reader reader(input);
  const std::size_t place = reader.word() * 2UL % valid.size(), size = reader.word();
  std::string text = valid;
  text.replace(place, size, text_of(reader.rest()));
  try {
    const Background background = background_of_csv("fuzzed.csv", text);
    require(background_of_csv("written.csv", csv_of(background)) == background,
            "a background is written as it was read");
  } catch (const InvalidInput& refusal) {
    require(std::string_view(refusal.what()).starts_with("fuzzed.csv:"), "an error names the file",
            refusal.what());
  }
}

}  // namespace racebeam::fuzz
