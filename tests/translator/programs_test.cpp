// Compares the interpreter and the translator. scripts/check/programs runs more programs.
#include <catch2/catch.hpp>

#include "emulator/translator/translator.hpp"
#include "tests/support/random_image.hpp"
#include "tests/support/skip.hpp"
#include "tests/translator/pair.hpp"

namespace racebeam::test {
namespace {

TEST_CASE("Random programs run translated as they run interpreted") {
  if (Translator::obstacle()[0] != '\0') {
    leave_out(Translator::obstacle());
    return;
  }
  for (std::uint32_t seed = 1; seed <= 2000; ++seed) {
    const std::string difference = difference_in_program(seed, 3);
    if (!difference.empty()) FAIL_CHECK(difference);
  }
  // With --cpu auto, which begins to translate after a while.
  for (std::uint32_t seed = 1; seed <= 200; ++seed) {
    const std::string difference = difference_in_program(seed, 60, CpuKind::kAuto);
    if (!difference.empty()) FAIL_CHECK(difference);
  }
}

TEST_CASE("Random programs for cartridges with an ARM run translated as they run interpreted") {
  if (Translator::obstacle()[0] != '\0') {
    leave_out(Translator::obstacle());
    return;
  }
  for (std::uint32_t seed = 1; seed <= 400; ++seed) {
    const bool lengthy = seed % 20 == 0;
    const std::string difference = difference_in_program(
        seed, lengthy ? 60 : 3, lengthy ? CpuKind::kAuto : CpuKind::kTranslator, make_arm_program);
    if (!difference.empty()) FAIL_CHECK(difference);
  }
}

// Straight code that accesses everything. The scheme follows from the seed.
Program make_program_of_scheme(std::uint32_t seed) {
  const auto schemes = random_schemes();
  const std::string_view scheme = schemes[seed % schemes.size()];
  return {scheme, *random_image(scheme, seed)->bytes};
}

TEST_CASE("Programs in each scheme run translated as they run interpreted") {
  if (Translator::obstacle()[0] != '\0') {
    leave_out(Translator::obstacle());
    return;
  }
  const auto schemes = static_cast<std::uint32_t>(random_schemes().size());
  for (std::uint32_t seed = 0; seed < 8 * schemes; ++seed) {
    const bool lengthy = seed / schemes == 0;
    const std::string difference = difference_in_program(
        seed, lengthy ? 30 : 3, lengthy ? CpuKind::kAuto : CpuKind::kTranslator, make_program_of_scheme);
    CHECK(difference == "");
  }
}

}  // namespace
}  // namespace racebeam::test
