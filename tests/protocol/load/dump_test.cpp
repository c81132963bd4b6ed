// Another dump of a game: it plays as the game does, and replies say that its image is another one.
#include <catch2/catch.hpp>

#include "protocol/encoding/base64.hpp"
#include "tests/protocol/duel.hpp"
#include "tests/support/needed_rom.hpp"

using namespace racebeam;
using Catch::Matchers::Contains;
using test::code;
using test::counter_image;
using test::LineClient;
using test::value;

namespace {

constexpr std::size_t kUnusedVector = 6;  // bytes before the end: the 6507 has no NMI

using Bytes = std::vector<std::uint8_t>;

Bytes dump_of(const Image& image) {
  Bytes bytes = *image.bytes;
  bytes[bytes.size() - kUnusedVector] ^= 1;
  return bytes;
}

std::string as_text(const Bytes& bytes) {
  std::string text;
  append_base64(text, bytes);
  return text;
}

// What the machine shows while every control is used.
std::string played(LineClient& client) {
  client.ask("observe reward lives ram screen:rle");
  std::string text;
  for (const char* action : {"FIRE*40", "RIGHT*40", "LEFT*80", "UP*40", "DOWN*40", "RIGHTFIRE*40"})
    text += client.ask("act " + std::string(action)) + '\n';
  return text;
}

std::string load_inline(const Bytes& bytes, const std::string& game) {
  return "load inline seed=7 sticky=0 as=" + game + " image=" + as_text(bytes);
}

const std::string kPaddleDuel = std::string(test::kDuel) + "[[image]]\nmd5 = '" + counter_image()->md5 +
                                "'\nleft = 'paddles'\nformat = 'PAL'\nheight = 220\n";

LineService paddle_duel_service(const Scratch& folder, const Bytes& image) {
  auto images = std::make_shared<Images>();
  images->add_file(folder.write("duel.bin", std::string(image.begin(), image.end())), std::nullopt,
                   folder.write("duel.toml", kPaddleDuel));
  LineService service = test::line_service();
  service.images = std::move(images);
  return service;
}

}  // namespace

TEST_CASE("Another dump of a game plays as the game does") {
  for (const std::string game : {"breakout", "pong", "kaboom", "casino", "backgammon", "blackjack",
                                 "warlords", "surround", "wizard_of_wor"}) {
    const auto image = test::needed_rom_of(game);
    if (!image) continue;
    INFO(game);
    LineClient original, dump;
    const std::string expected = original.ask(load_inline(*image->bytes, game)),
                      reply = dump.ask(load_inline(dump_of(*image), game));
    CHECK(value(expected, "image") == "(none)");
    CHECK(value(reply, "image") == "other");
    for (const char* key : {"left", "right", "format", "ystart", "height"})
      CHECK(value(reply, key) == value(expected, key));
    if (game == "kaboom" || game == "blackjack") continue;  // they read random numbers in all of their image
    CHECK(played(original) == played(dump));
  }
}

TEST_CASE("Another dump of a user's game has the controllers and the picture of the game") {
  const Scratch folder;
  const Bytes image = *counter_image()->bytes, dump = dump_of(*counter_image());
  LineClient original(paddle_duel_service(folder, image)), other(paddle_duel_service(folder, dump));
  const std::string load = "load duel seed=7 sticky=0", reply = original.ask(load),
                    other_reply = other.ask(load);
  CHECK(value(reply, "height") == "220");
  CHECK(value(other_reply, "height") == "220");
  CHECK(value(other_reply, "format") == "pal");
  CHECK(value(other_reply, "image") == "other");
  CHECK_THAT(other.ask("settings"), Contains(" image=other "));
  CHECK_THAT(reply, !Contains("image="));
  CHECK(played(original) == played(other));
}

TEST_CASE("as= takes a game of the server's own game file") {
  const Scratch folder;
  LineClient client(paddle_duel_service(folder, *counter_image()->bytes));
  const std::string reply = client.ask(load_inline(dump_of(*counter_image()), "duel"));
  CHECK(value(reply, "game") == "duel");
  CHECK(value(reply, "rule") == "1");
  CHECK(value(reply, "height") == "220");
  CHECK(code(client.ask("load duel as=duell")) == "unknown-game");
}

TEST_CASE("A service warns of each image that the rule of another one scores") {
  const Scratch folder;
  const auto warnings = [&](const Bytes& image) {
    return paddle_duel_service(folder, image).images->warnings();
  };
  CHECK(warnings(*counter_image()->bytes).empty());
  const auto warnings_of_dump = warnings(dump_of(*counter_image()));
  REQUIRE(warnings_of_dump.size() == 1);
  CHECK_THAT(warnings_of_dump.front(), Contains("the rule of 'duel' was written for"));
}
