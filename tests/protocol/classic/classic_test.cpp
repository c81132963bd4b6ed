#include "protocol/classic/classic.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "environment/saved_state.hpp"
#include "games/catalogue.hpp"
#include "protocol/encoding/text.hpp"
#include "tests/support/counter_image.hpp"

using namespace racebeam;
using Catch::Matchers::Contains;

namespace {

Environment make_machine(Settings settings = {}) {
  settings.classic = true;
  settings.random_seed = 123;
  settings.sticky = 0;
  const auto image = load_image("builtin:beamfall");
  return {image, recognise(*image).game, settings};
}

Environment make_paddle_machine() {
  Settings settings;
  settings.classic = true;
  settings.random_seed = 123;
  settings.sticky = 0;
  const std::string paddles = std::string("[[image]]\nleft = \"paddles\"\n");
  return {test::counter_image(), test::game(test::kSteeredGame + paddles), settings};
}

struct Client {
  explicit Client(Settings settings = {}, const ClassicOptions& options = {})
      : Client(make_machine(settings), options) {}
  explicit Client(Environment its_machine, const ClassicOptions& options = {})
      : machine(std::move(its_machine)), session(machine, options) {}

  // Sends the text. Returns all output.
  std::string say(const std::string& text) {
    std::string answers = listen();
    for (std::size_t at = 0; at < text.size();) {
      const std::span<char> space = session.space();
      const std::size_t count = text.copy(space.data(), space.size(), at);
      session.received(count);
      at += count;
      answers += listen();
    }
    return answers;
  }

  // Says the text, and then closes the client's end.
  std::string say_and_close(const std::string& text) {
    const std::string answers = say(text);
    session.received(0);
    return answers + listen();
  }

  std::string listen() {
    std::string answers;
    while (!session.ended()) {
      const auto text = session.reply();
      if (!text) break;
      answers += *text;
    }
    return answers;
  }

  Environment machine;
  ClassicSession session;
};

std::string refusal(Client& client, const std::string& text, int status) {
  try {
    client.say(text);
  } catch (const ClassicError& error) {
    CHECK(error.status() == status);
    return error.what();
  }
  return "accepted";
}

std::string hex(std::span<const std::uint8_t> bytes) {
  std::string text;
  append_hex(text, bytes);
  return text;
}

}  // namespace

TEST_CASE("The server speaks first and says the size of the screen") {
  Client client;
  CHECK(client.say("") == "160-210\n");
}

TEST_CASE("The first data line follows the flags at once") {
  Client client;
  CHECK(client.say("0,0,0,1\n") == "160-210\n0,0:\n");
}

TEST_CASE("RAM comes before the screen, and every field ends with a colon") {
  Client client({}, {.run_length = false});
  client.listen();
  const std::string line = client.say("1,1,0,1\n");
  CHECK(line == hex(client.machine.ram()) + ":" + hex(client.machine.screen()) + ":0,0:\n");
  CHECK(line.size() == 256 + 1 + 67200 + 1 + 4 + 1);
}

TEST_CASE("Screens are written as runs by default") {
  Client client;
  client.listen();
  std::string runs;
  append_run_length(runs, client.machine.screen());
  CHECK(client.say("1,0,0,0\n") == runs + ":\n");
}

TEST_CASE("The third flag is ignored, but must be there") {
  Client client;
  CHECK(client.say("0,0,7,1\n") == "160-210\n0,0:\n");
  Client other;
  CHECK_THAT(refusal(other, "0,0,1\n", kMalformedStatus), Contains("3 numbers"));
}

TEST_CASE("Without any flag, the line is empty") {
  Client client;
  CHECK(client.say("0,0,0,0\n3,18\n") == "160-210\n\n\n");
}

TEST_CASE("Blanks, carriage returns and further numbers in a line do no harm") {
  Client client;
  CHECK(client.say(" 0 , 0,0, 1,5\r\n 3 , 18 \r\n3,18,7\n") == "160-210\n0,0:\n0,0:\n0,0:\n");
}

TEST_CASE("Saving, loading and resetting run no frame") {
  Client client;
  client.say("0,0,0,1\n3,18\n3,18\n43,18\n3,18\n");
  CHECK(client.machine.frame_number() == 3);
  CHECK(client.say("44,0\n") == "0,0:\n");
  CHECK(client.machine.frame_number() == 2);
  CHECK(client.say("45,45\n") == "0,0:\n");
  CHECK(client.machine.frame_number() == 2);
}

TEST_CASE("Saved states are a stack that a reset leaves alone") {
  Client client;
  client.say("0,0,0,1\n3,18\n43,18\n3,18\n3,18\n43,18\n3,18\n45,18\n44,18\n");
  CHECK(client.machine.frame_number() == 3);
  client.say("44,18\n");
  CHECK(client.machine.frame_number() == 1);
  CHECK_THAT(refusal(client, "44,18\n", kMalformedStatus), Contains("none that it saved (43) is left"));
}

TEST_CASE("The stack keeps the newest 4096 states") {
  Client client;
  client.say("0,0,0,0\n");
  for (std::size_t i = 0; i < kMaxClassicStates + 2; ++i) {
    if (client.machine.game_over()) client.say("45,18\n");
    client.say("43,18\n3,18\n");
  }
  for (std::size_t i = kMaxClassicStates + 2; i-- > 2;) {
    client.say("44,18\n");
    if (client.machine.frame_number() != static_cast<int>(i)) FAIL("not the state of frame " << i);
  }
  CHECK_THAT(refusal(client, "44,18\n", kMalformedStatus), Contains("the newest 4096 are kept"));
}

TEST_CASE("A saved state holds no pictures") {
  Client client;
  client.say("1,0,0,0\n3,18\n");
  const auto pictures = client.machine.save_without_pictures()->pictures;
  CHECK_FALSE(pictures.current);
  CHECK_FALSE(pictures.previous);
}

TEST_CASE("The screen is recorded before each frame of an act, and for frames that the end leaves out") {
  std::vector<int> frames;
  const auto record = [&](const Environment& machine) { frames.push_back(machine.frame_number()); };
  Client client({.frame_skip = 3, .max_episode_frames = 7}, {.record = record});
  client.say_and_close("0,0,0,0\n3,18\n43,18\n3,18\n44,18\n3,18\n3,18\n3,18\n45,18\n3,18\n");
  // Two acts; a third, from the state of the first; one that ends the episode, and one after its end; a
  // reset; an act; and the act at the end of input.
  CHECK(frames == std::vector{0, 1, 2, 3, 4, 5, 3, 4, 5, 6, 7, 7, 7, 7, 7, 7, 8, 9, 10, 11, 12});
}

TEST_CASE("After loading, screen and RAM are those from before until a frame has run") {
  Client client;
  client.say("1,1,0,0\n1,18\n43,18\n");
  for (int frame = 0; frame < 30; ++frame) client.say("3,18\n");
  const std::string before = client.say("43,18\n");
  client.say("44,18\n");
  CHECK(client.say("44,18\n") == before);
  CHECK(client.say("3,18\n") != before);
}

TEST_CASE("The frame limit replaces a data line by DIE") {
  Client client({}, {.max_num_frames = 5});
  CHECK(client.say("0,0,0,1\n3,18\n3,18\n3,18\n3,18\n3,18\n3,18\n") ==
        "160-210\n0,0:\n0,0:\n0,0:\n0,0:\n0,0:\nDIE\n");
  CHECK(client.session.ended());
}

TEST_CASE("The frame limit counts frames, not lines") {
  Client client({.frame_skip = 4}, {.max_num_frames = 5});
  CHECK(client.say("0,0,0,1\n3,18\n3,18\n") == "160-210\n0,0:\n0,0:\nDIE\n");
}

TEST_CASE("An episode that is over stays so until a reset") {
  Client client({.max_episode_frames = 3});
  CHECK(client.say("0,0,0,1\n0,18\n0,18\n0,18\n0,18\n99,18\n45,18\n0,18\n") ==
        "160-210\n0,0:\n0,0:\n0,0:\n1,0:\n1,0:\n1,0:\n0,0:\n0,0:\n");
}

TEST_CASE("The end of input is answered by DIE, whatever came before") {
  Client nothing;
  CHECK(nothing.say_and_close("") == "160-210\nDIE\n");
  Client flags;
  CHECK(flags.say_and_close("0,0,0,1\n") == "160-210\n0,0:\nDIE\n");
  Client half;
  CHECK(half.say_and_close("0,0,0,1\n3,18") == "160-210\n0,0:\nDIE\n");
  CHECK(half.machine.frame_number() == 1);
}

TEST_CASE("An action that does not exist ends the session as the classic server ends") {
  for (const std::string a : {"-1", "18", "39", "41", "42", "46", "99999999999"}) {
    Client client;
    client.say("0,0,0,1\n");
    CHECK_THAT(refusal(client, a + ",18\n", kUnknownActionStatus), Contains("asked for action"));
  }
}

TEST_CASE("Player B's action is never refused") {
  Client client;
  client.say("0,0,0,1\n");
  for (const std::string b : {"0", "45", "18", "35", "40", "36", "-7", "fire"})
    CHECK(client.say("3," + b + "\n") == "0,0:\n");
  CHECK(client.machine.frame_number() == 8);
}

TEST_CASE("Both players turn their paddles with strength 1") {
  Client client(make_paddle_machine());
  const auto paddles = [&] { return client.machine.save()->values.play.paddles; };
  client.say("0,0,0,1\n");
  const PaddleValues middle = paddles();
  client.say("0,22\n");  // player B's LEFT
  CHECK(paddles() == PaddleValues{middle[0], middle[1] + 23000});
  client.say("3,18\n");
  CHECK(paddles() == PaddleValues{middle[0] - 23000, middle[1] + 23000});
  client.say("0,21\n");
  CHECK(paddles() == PaddleValues{middle[0] - 23000, middle[1]});
}

TEST_CASE("40 runs a frame in which player A presses nothing") {
  Client pressing, idle;
  pressing.say("0,1,0,0\n");
  idle.say("0,1,0,0\n");
  CHECK(pressing.say("40,18\n40,40\n") == idle.say("0,18\n0,18\n"));
  CHECK(pressing.machine.frame_number() == 2);
}

TEST_CASE("Lines with too few parts are refused") {
  for (const std::string line : {"", "3", ",", "3,,,", "fire"}) {
    Client client;
    client.say("0,0,0,1\n");
    CHECK_THAT(refusal(client, line + "\n", kMalformedStatus), Contains("two actions"));
  }
  for (const std::string line : {"", "1,1,1", "flags"}) {
    Client client;
    CHECK_THAT(refusal(client, line + "\n", kMalformedStatus), Contains("four flags"));
  }
}

TEST_CASE("A line of more than 2047 bytes is seen as two") {
  Client client;
  client.say("0,0,0,1\n");
  CHECK(client.say("3,18" + std::string(2043, ' ') + "3,18\n") == "0,0:\n0,0:\n");
  CHECK(client.say("3,18" + std::string(2042, ' ') + "\n") == "0,0:\n");
}
