#include "recording/footage.hpp"

namespace racebeam {

Footage footage_of(const Environment& machine) {
  const Format format = machine.format();
  const int rate = format == Format::kPal || format == Format::kSecam ? 50 : 60;
  return {static_cast<std::size_t>(machine.height()), palette(format), rate};
}

}  // namespace racebeam
