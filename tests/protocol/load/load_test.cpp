// The arguments of `load`: image, settings, presets and rules.
#include <catch2/catch.hpp>

#include "protocol/encoding/base64.hpp"
#include "tests/protocol/line_client.hpp"

using namespace racebeam;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using test::code;
using test::kLoad;
using test::LineClient;
using test::value;

TEST_CASE("A load that is refused leaves the game before it running") {
  LineClient client;
  client.ask(kLoad);
  client.say("observe frame\nact NOOP\nsave here\n");
  for (const std::string words : {"nothing",
                                  "beamfall sticky=2",
                                  "beamfall sticky=nan",
                                  "beamfall seed=-1",
                                  "beamfall seed=-0",
                                  "beamfall frame_skip=-00",
                                  "beamfall seed=4294967296",
                                  "beamfall frame_skip=0",
                                  "beamfall frame_skip=4-2",
                                  "beamfall frame_skip=2-",
                                  "beamfall mode=7",
                                  "beamfall color=1",
                                  "beamfall sticky",
                                  "beamfall preset=dqn",
                                  "beamfall reward_min=1 reward_max=0",
                                  "beamfall rules=corrected",
                                  "inline",
                                  "inline image=!!!!",
                                  "inline image=",
                                  "inline image=AAAA",
                                  "beamfall image=AAAA",
                                  "beamfall as=nothing",
                                  "../../etc/passwd",
                                  "/etc/passwd",
                                  "builtin:beamfall"}) {
    INFO(words);
    CHECK(code(client.ask("load " + words)) != "");
    CHECK(client.ask("act NOOP").starts_with("ok frame="));
  }
  CHECK(client.ask("restore here") == "ok frame=1");
}

TEST_CASE("A refusal of a setting names the value that was given") {
  LineClient client;
  CHECK_THAT(client.ask("load beamfall frame_skip=-1"),
             StartsWith("error bad-value frame_skip is '-1'; it takes a whole number from 1 to 1000"));
  CHECK_THAT(client.ask("load beamfall as=space_invaders mode=5"),
             StartsWith("error bad-value mode 0 of space_invaders could not be set up") &&
                 Contains("; a machine begins in mode 0, the default, before it takes mode 5"));
  CHECK_THAT(client.ask("load beamfall as=space_invaders"), !Contains("before it takes"));
}

TEST_CASE("The console of an image can be told, is shown, and is refused where it does not fit") {
  LineClient client;
  const auto screen_of = [&](const std::string& words) {
    const std::string reply = client.ask("load beamfall " + words);
    CHECK(client.ask("settings") == reply);
    std::string values;
    for (const char* key : {"scheme", "left", "right", "format", "ystart", "height"})
      values += (values.empty() ? "" : " ") + value(reply, key);
    return values;
  };
  CHECK(screen_of("") == "4K joystick joystick ntsc 34 210");
  CHECK(screen_of("scheme=auto left=paddles") == "4K paddles joystick ntsc 34 210");
  CHECK(screen_of("scheme=2K right=paddles format=PAL ystart=40") == "2K joystick paddles pal 40 250");
  CHECK(screen_of("height=220 scheme=CV_4K") == "CV_4K joystick joystick ntsc 34 220");
  const std::string reply = client.ask("games beamfall");
  CHECK(value(reply, "scheme") == "4K");
  CHECK(value(reply, "left") == "joystick");
  for (const auto& [words, sentence] :
       {std::pair("scheme=F8", "the cartridge scheme F8 needs an image of at least 8192 bytes"),
        {"scheme=BUS", "unsupported cartridge scheme 'BUS'"},
        {"scheme=F9", "unknown cartridge scheme 'F9'"},
        {"left=mindlink", "left is 'mindlink'; it takes joystick, paddles"},
        {"format=hd", "format is 'hd'; it takes auto, ntsc, pal, pal60, secam"},
        {"height=99", "height is '99'; it takes a whole number from 100 to 256"},
        {"ystart=51", "ystart is '51'; it takes a whole number from 0 to 50"},
        {"ystart=50 height=256", "the sum of ystart and height is 306; it must be at most 300"}})
    CHECK_THAT(client.ask("load beamfall " + std::string(words)),
               StartsWith("error bad-value " + std::string(sentence)));
}

TEST_CASE("A random seed is a fresh one, wherever a seed is given") {
  LineClient client;
  const std::string first = value(client.ask("load beamfall seed=random"), "seed");
  CHECK(first != "0");
  client.ask("reset seed=random");
  const std::string second = value(client.ask("settings"), "seed");
  CHECK(second != "0");
  CHECK(second != first);
  client.ask("open 2");
  CHECK(client.ask("restart seed=random").starts_with("ok machines=2 | "));
}

// The score of tetris is in two bytes that beamfall does not change; the corrected rule knows its wrap.
TEST_CASE("Corrected rules are a setting, and no state goes from one to the other") {
  LineClient client;
  std::string exported;
  for (const auto& [rules, gain] : {std::pair("ale-0.12", "0"), {"fixed", "1"}}) {
    const std::string reply = client.ask("load beamfall as=tetris sticky=0 rules=" + std::string(rules));
    CHECK(value(reply, "rules") == rules);
    client.say("observe reward\npoke 113 9999\nact NOOP\npoke 113 0000\n");
    CHECK(client.ask("act NOOP") == "ok reward=" + std::string(gain));
    if (!exported.empty()) CHECK(code(client.ask("import a " + exported)) == "bad-state");
    client.ask("save a");
    exported = value(client.ask("export a"), "data");
  }
}

TEST_CASE("The minimal actions are those of the rules in force") {
  LineClient client;
  client.ask("load beamfall as=blackjack action_set=minimal");
  CHECK(code(client.ask("act RIGHT")) == "bad-action");
  client.ask("load beamfall as=blackjack action_set=minimal rules=fixed");
  CHECK(client.ask("act RIGHT").starts_with("ok "));
  CHECK(value(client.ask("actions"), "actions") == "0:NOOP,1:FIRE,3:RIGHT,4:LEFT");
}

TEST_CASE("A preset comes before the settings that change it, wherever it stands") {
  LineClient client;
  const std::string reply = client.ask("load beamfall frame_skip=2-4 preset=dqn2015 seed=3 noop_max=0");
  CHECK(value(reply, "frame_skip") == "2-4");
  CHECK(value(reply, "sticky") == "0");
  CHECK(value(reply, "life_loss") == "restart");
  CHECK(value(reply, "life_loss_ends") == "1");
  CHECK(value(reply, "preset") == "dqn2015");
  CHECK(value(reply, "noop_max") == "0");
  CHECK(client.ask("settings") == reply);
}

TEST_CASE("Without a seed the server picks one, and says which") {
  LineClient client;
  const std::string seed = value(client.ask("load beamfall"), "seed");
  CHECK(seed != "0");
  CHECK(value(client.ask("load beamfall seed=" + seed), "seed") == seed);
}

TEST_CASE("An image can be sent, is recognised, and plays the same") {
  LineClient by_name, sent;
  const auto image = load_image("builtin:beamfall");
  std::string text;
  append_base64(text, *image->bytes);
  by_name.ask(kLoad);
  CHECK(value(sent.ask("load inline sticky=0 seed=7 image=" + text), "game") == "beamfall");
  for (LineClient* client : {&by_name, &sent}) client->ask("observe reward lives ram screen:rle");
  CHECK(sent.ask("act FIRE*50 UP*9") == by_name.ask("act FIRE*50 UP*9"));
}

TEST_CASE("A range of frames is drawn anew for each act, by the seed") {
  LineClient one, other;
  std::string lengths;
  for (LineClient* client : {&one, &other}) client->ask("load beamfall seed=5 frame_skip=2-4");
  for (int act = 0; act < 60; ++act) {
    const std::string reply = one.say("observe frames\nact NOOP\n");
    CHECK(reply == other.say("observe frames\nact NOOP\n"));
    lengths += value(reply, "frames")[0];
  }
  for (const char length : {'2', '3', '4'}) CHECK(std::ranges::count(lengths, length) > 8);
  CHECK(lengths.find_first_not_of("234\n") == std::string::npos);
}

TEST_CASE("A mode that the image does not reach is refused, and nothing changes") {
  LineClient client;  // updraft has no such switch as pong, whose modes are counted by it
  client.ask(kLoad);
  CHECK_THAT(client.ask("load updraft as=pong mode=3"),
             StartsWith("error bad-value mode 3 of pong could not be set up on this image"));
  CHECK(value(client.ask("settings"), "game") == "beamfall");
  client.say("load updraft seed=7 as=pong\nobserve frame reward ram screen acts\nact FIRE*9\n");
  CHECK(code(client.ask("open 2")) == "");
  const std::string machines = client.ask("restart 00"), shown = client.ask("look");
  client.ask("set mode=3");
  CHECK(code(client.ask("reset")) == "bad-value");
  CHECK(client.ask("look") == shown);
  CHECK(code(client.ask("open 2")) == "bad-value");
  CHECK(client.ask("restart 00") == machines);
}

TEST_CASE("What is given twice is refused") {
  LineClient client;
  client.ask(kLoad);
  for (const std::string request :
       {"load beamfall seed=1 seed=2", "load beamfall preset=dqn2015 preset=gym-v5",
        "load inline image=AAAA image=AAAA", "load beamfall as=beamfall as=updraft", "set mode=0 mode=0"}) {
    const std::string reply = client.ask(request);
    CHECK_THAT(reply, StartsWith("error bad-arguments ") && Contains(" is given twice"));
  }
  CHECK(value(client.ask("settings"), "seed") == "7");
}

TEST_CASE("The names of a game's memory are in a reply, and those of the TIA in each one") {
  LineClient client;
  client.ask(kLoad);
  const std::string names = client.ask("names");
  CHECK_THAT(value(names, "ram_names"), Contains("1:lives,2:score"));
  CHECK_THAT(value(names, "tia_names"), StartsWith("VSYNC,VBLANK,"));
}
