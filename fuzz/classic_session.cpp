// A session of the classic protocol. The first byte selects options; the rest is the client's input.
#include "fuzz/support/keep_code.hpp"
#include "fuzz/support/target.hpp"
#include "games/catalogue.hpp"
#include "protocol/classic/classic.hpp"

namespace racebeam::fuzz {
namespace {

enum Option : unsigned {
  kRunLength = 1,
  kFewFrames = 2,
  kEpisodes = 4,
  kSticky = 8,
  kAveraging = 16,
  kUpdraft = 32
};

Cartridge cartridge_of(const char* where) {
  const auto image = load_image(where);
  const Cartridge cartridge{image, recognise(*image).game};
  keep_code(cartridge);
  return cartridge;
}

Environment make_machine(unsigned options) {
  static const Cartridge beamfall = cartridge_of("builtin:beamfall"),
                         updraft = cartridge_of("builtin:updraft");
  Settings settings;
  settings.classic = true;
  settings.random_seed = 1;
  settings.sticky = (options & kSticky) != 0 ? 0.25F : 0;
  settings.max_episode_frames = (options & kEpisodes) != 0 ? 20 : 0;
  settings.color_averaging = (options & kAveraging) != 0;
  const Cartridge& cartridge = (options & kUpdraft) != 0 ? updraft : beamfall;
  return {cartridge.image, cartridge.game, settings};
}

// All output of the session for the text, which is sent in pieces of at most `piece` bytes. An error that
// ends the session comes last.
std::string conversation(unsigned options, std::string_view text, std::size_t piece) {
  Environment machine = make_machine(options);
  ClassicSession session(machine, {.run_length = (options & kRunLength) != 0,
                                   .max_num_frames = (options & kFewFrames) != 0 ? 30 : 0});
  std::string requests;
  const auto listen = [&] {
    while (!session.ended()) {
      const auto reply = session.reply();
      if (!reply) return;
      require(reply->ends_with('\n'), "the server's output consists of lines");
      require(is_printable(reply->substr(0, reply->size() - 1)), "lines are printable");
      requests += *reply;
    }
  };
  try {
    for (listen(); !text.empty() && !session.ended(); listen()) {
      const std::span<char> space = session.space();
      const std::size_t count = std::min({space.size(), text.size(), piece});
      require(count > 0, "a session that waits has space");
      std::copy_n(text.begin(), count, space.begin());
      session.received(count);
      text.remove_prefix(count);
    }
    if (!session.ended()) {
      session.received(0);
      listen();
      require(session.ended(), "a session whose input has ended ends");
    }
  } catch (const ClassicError& error) {
    require(*error.what() != '\0' && is_printable(error.what()), "an error has a message");
    requests += error.what();
  }
  return requests;
}

}  // namespace

void run(Bytes input) {
  Reader reader(input);
  const unsigned options = reader.byte();
  const std::string_view text = text_of(reader.rest());
  const std::string requests = conversation(options, text, 4096);
  require(requests == conversation(options, text, 1 + options % 7),
          "answers do not depend on the pieces of the input");
}

}  // namespace racebeam::fuzz
