// The environment of an RL-Glue experiment: the first byte selects options, and messages follow. A message
// has a byte of its type, a byte of its size, and its payload.
#include "protocol/classic/rl_glue.hpp"

#include <stdexcept>

#include "fuzz/support/keep_code.hpp"
#include "fuzz/support/target.hpp"

namespace racebeam::fuzz {
namespace {

enum Option : unsigned { kColours = 1, kMinimalActions = 2, kFewFrames = 4 };
constexpr int kMaxMessages = 64;

Cartridge beamfall() {
  const auto image = load_image("builtin:beamfall");
  const Cartridge cartridge{image, recognise(*image).game};
  keep_code(cartridge);
  return cartridge;
}

RlGlueOptions options_of(unsigned byte) {
  return {.rgb = (byte & kColours) != 0,
          .minimal_actions = (byte & kMinimalActions) != 0,
          .max_num_frames = (byte & kFewFrames) != 0 ? 8 : 0};
}

void check(std::string_view answer, std::uint32_t type) {
  require(answer.size() >= kRlGlueHeaderBytes, "an answer has a header");
  const RlGlueHeader header = rl_glue_header(answer.substr(0, kRlGlueHeaderBytes));
  require(header.type == type, "an answer has the type of its message");
  require(header.size == answer.size() - kRlGlueHeaderBytes, "an answer has the size that it names");
}

}  // namespace

void run(Bytes input) {
  static const Cartridge cartridge = beamfall();
  Reader reader(input);
  Environment environment(cartridge.image, cartridge.game, {.random_seed = 1});
  RlGlueEnvironment session(environment, options_of(reader.byte()));
  for (int message = 0; message < kMaxMessages && !reader.empty(); ++message) {
    const std::uint32_t type = reader.byte();
    const std::size_t size = reader.byte();
    try {
      const auto answer = session.answer(type, text_of(reader.take(size)));
      if (!answer) return;
      check(*answer, type);
    } catch (const std::invalid_argument& refusal) {
      require(is_printable(refusal.what()), "a refused message gives a printable sentence", refusal.what());
      return;
    }
  }
}

}  // namespace racebeam::fuzz
