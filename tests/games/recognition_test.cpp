#include <catch2/catch.hpp>

#include "games/catalogue.hpp"
#include "system/similar.hpp"
#include "tests/games/scratch.hpp"

using namespace racebeam;
using Catch::Contains;

namespace {

const std::string kSeaquest = "240bfbac5163af4df5ae713985386f92",
                  kNobody = "00000000000000000000000000000000";
const std::string kGame = "title = 'Mine'\n[rule]\nstep = '''\nscore = ram[0x80]\nterminal = 0\n'''\n";

Image image(const std::string& md5, const std::string& stem) {
  return {std::make_shared<const std::vector<std::uint8_t>>(4096), md5, stem};
}

}  // namespace

TEST_CASE("an image is recognised by its MD5 before its name") {
  const Recognition found = recognise(image(kSeaquest, "pong"));
  CHECK(found.game->name == "seaquest");
  CHECK(found.how == RecognisedBy::kMd5);
  CHECK(found.md5_matches);
}

TEST_CASE("an image with another MD5 is recognised by its file name, with a mismatch to warn of") {
  const Recognition found = recognise(image(kNobody, "pong"));
  CHECK(found.game->name == "pong");
  CHECK(found.how == RecognisedBy::kFileName);
  CHECK_FALSE(found.md5_matches);
}

TEST_CASE("a name that is given wins over the MD5") {
  const Recognition found = recognise(image(kSeaquest, "seaquest"), "pong");
  CHECK(found.game->name == "pong");
  CHECK(found.how == RecognisedBy::kGivenName);
  CHECK_FALSE(found.md5_matches);
  CHECK(recognise(image(kSeaquest, "x"), "seaquest").md5_matches);
}

TEST_CASE("a game file that is given wins over the MD5") {
  const Scratch scratch;
  const std::string file = scratch.write("Mine.toml", kGame);
  const Recognition found = recognise(image(kSeaquest, "seaquest"), std::nullopt, file);
  CHECK(found.game->title == "Mine");
  CHECK(found.game->name == "mine");
  CHECK(found.how == RecognisedBy::kGivenFile);
  CHECK(found.md5_matches);  // it names no image, so that any will do
  const std::string other = scratch.write("other.toml", kGame + "[[image]]\nmd5 = '" + kNobody + "'\n");
  CHECK_FALSE(recognise(image(kSeaquest, "seaquest"), std::nullopt, other).md5_matches);
  CHECK_THROWS_WITH(recognise(image(kSeaquest, "seaquest"), "pong", file), Contains("not both"));
}

TEST_CASE("a folder of game files decides by MD5, then by name, before the catalogue") {
  const Scratch scratch;
  scratch.write("first.toml", kGame);
  scratch.write("pong.toml", kGame + "[[image]]\nmd5 = '" + kSeaquest + "'\n");
  scratch.write("notes.txt", "no game");
  const auto found = [&](const std::string& md5, const std::string& stem) {
    return recognise(image(md5, stem), std::nullopt, scratch.path("")).game;
  };
  CHECK(found(kSeaquest, "first")->name == "pong");
  CHECK(found(kSeaquest, "first")->title == "Mine");
  CHECK(found(kNobody, "first")->name == "first");
  CHECK(found(kNobody, "kaboom")->title == "Kaboom!");
  CHECK_FALSE(found(kNobody, "else")->has_rule());
  scratch.write("wrong.toml", "title = 1");
  CHECK_THROWS_WITH(found(kNobody, "else"), Contains("wrong.toml:1: title"));
}

TEST_CASE("an unknown image runs without a rule, under its file name") {
  const Recognition found = recognise(image(kNobody, "my_demo"));
  CHECK(found.game->name == "my_demo");
  CHECK(recognise(image(kNobody, "my own, demo|1.0")).game->name == "my_own__demo_1.0");
  CHECK_FALSE(found.game->has_rule());
  CHECK(found.how == RecognisedBy::kNothing);
  CHECK(found.game->minimal_actions.size() == 18);
  CHECK(found.game->properties_for(kNobody) == Properties{});
}

TEST_CASE(
    "another dump of a known game gets its properties under any name, but its rule under the game's name "
    "only") {
  const std::string dump = "dbdaf82f4f0c415a94d1030271a9ef44";
  const Recognition unknown = recognise(image(dump, "thing"));
  CHECK(unknown.how == RecognisedBy::kNothing);
  CHECK(unknown.game->properties_for(dump).left == Controller::kPaddles);
  CHECK_FALSE(unknown.game->has_rule());
  const Recognition named = recognise(image(dump, "kaboom"));
  CHECK(named.how == RecognisedBy::kFileName);
  CHECK(named.game->properties_for(dump).left == Controller::kPaddles);
  CHECK_FALSE(named.md5_matches);
}

TEST_CASE("a known image keeps its properties when it is scored as another game") {
  const std::string warlords = "cbe5a166550a8129a5e6d374901dffad";
  const Recognition found = recognise(image(warlords, "warlords"), "frogger");
  CHECK(found.game->name == "frogger");
  CHECK_FALSE(found.md5_matches);
  const auto& game = found.game;
  for (const auto& variant : {game, game->fixed, game->classic, game->classic->fixed})
    CHECK(variant->properties_for(warlords).left == Controller::kPaddles);
}

TEST_CASE("another dump of a game takes the properties of the game's first image") {
  for (const std::string name :
       {"breakout", "pong", "kaboom", "casino", "backgammon", "blackjack", "warlords", "surround",
        "wizard_of_wor", "maze_craze", "pooyan", "asteroids"}) {
    INFO(name);
    const Properties expected = find_game(name)->images.front().properties;
    REQUIRE_FALSE(expected == Properties{});
    for (const Recognition& found :
         {recognise(image(kNobody, "dump"), name), recognise(image(kNobody, name))}) {
      CHECK(found.game->properties_for(kNobody) == expected);
      CHECK_FALSE(found.md5_matches);
      CHECK_FALSE(found.game->accepts(kNobody));
      if (const auto& fixed = found.game->fixed) CHECK(fixed->properties_for(kNobody) == expected);
      if (const auto& classic = found.game->classic) CHECK(classic->properties_for(kNobody) == expected);
    }
  }
}

TEST_CASE("another dump takes the scheme of the game's first image only where it fits") {
  const Scratch scratch;
  const auto scheme_with = [&](const std::string& scheme) {
    const std::string file =
        scratch.write("mine.toml", kGame + "[[image]]\nmd5 = '" + kSeaquest +
                                       "'\nleft = 'paddles'\nscheme = '" + scheme + "'\n");
    const auto game = recognise(image(kNobody, "dump"), std::nullopt, file).game;
    CHECK(game->properties_for(kNobody).left == Controller::kPaddles);
    return game->properties_for(kNobody).scheme;
  };
  CHECK(scheme_with("3F") == "3F");
  CHECK(scheme_with("F8").empty());  // needs 8192 bytes
}

TEST_CASE("an unknown name is refused with those that are like it") {
  CHECK_THROWS_WITH(recognise(image(kNobody, "x"), "seaqest"),
                    Contains("'seaqest'") && Contains("did you mean seaquest"));
  CHECK_THROWS_WITH(recognise(image(kNobody, "x"), "montezuma"), Contains("montezuma_revenge"));
  CHECK_THROWS_WITH(recognise(image(kNobody, "x"), "xyzzyplugh"), Contains("`racebeam games`"));
  CHECK_THROWS_WITH(recognise(image(kNobody, "x"), ""), Contains("unknown game ''"));
}

TEST_CASE("names that are like another are found, the nearest first") {
  const auto similar = [](std::string_view name) { return similar_names(name, game_names()); };
  CHECK(similar("pitfal") == std::vector<std::string_view>{"pitfall", "pitfall2"});
  CHECK(similar("MONTEZUMA") == std::vector<std::string_view>{"montezuma_revenge"});
  CHECK(similar("pogn") == std::vector<std::string_view>{"pong"});
  for (const std::string& name :
       {std::string(), std::string("x"), std::string("zz"), std::string(1 << 20, 'a')})
    CHECK(similar(name).empty());
  const std::vector<std::string_view> actions = {"NOOP", "FIRE", "UP", "UPFIRE", "LEFTFIRE"};
  CHECK(did_you_mean("fire", actions) == " did you mean FIRE?");
  CHECK(did_you_mean("UPFIR", actions) == " did you mean UPFIRE?");
  CHECK(did_you_mean("SELECT", actions).empty());
}
