// Corrected rules (docs/rules.md): rewards across the wrap of a score, and other corrections of --rules
// fixed.
#include <catch2/catch.hpp>

#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "games/catalogue.hpp"
#include "tests/games/game_text.hpp"

using namespace racebeam;

namespace {

// Decimal digits, two a byte, least significant first; and the value of the last digit.
struct DecimalScore {
  const char* game;
  std::vector<int> addresses;
  int unit;
};

const DecimalScore kDecimalScores[] = {
    {"air_raid", {0xAA, 0xA9, 0xA8}, 1},
    {"amidar", {0xD9, 0xDA, 0xDB}, 1},
    {"assault", {0x82, 0x81, 0x80}, 1},
    {"asterix", {0xE0, 0xDF, 0xDE}, 1},
    {"atlantis", {0xA2, 0xA3, 0xA1}, 100},
    {"atlantis2", {0xA1, 0xA2, 0xA3}, 1},
    {"bank_heist", {0xDA, 0xD9, 0xD8}, 1},
    {"beam_rider", {0x89, 0x8A, 0x8B}, 1},
    {"berzerk", {0xDF, 0xDE, 0xDD}, 1},
    {"carnival", {0xAE, 0xAD}, 10},
    {"centipede", {0xF6, 0xF5, 0xF4}, 1},
    {"chopper_command", {0xEE, 0xEC}, 100},
    {"crossbow", {0x8D, 0x8C, 0x8B}, 1},
    {"darkchambers", {0xCC, 0xCF}, 10},
    {"demon_attack", {0x85, 0x83, 0x81}, 1},
    {"donkey_kong", {0x88, 0x87}, 100},
    {"elevator_action", {0x89, 0x88, 0x87}, 1},
    {"et", {0xE1, 0xE0, 0xDF}, 1},
    {"frogger", {0xCE, 0xCC}, 1},
    {"frostbite", {0xCA, 0xC9, 0xC8}, 1},
    {"gopher", {0xB2, 0xB1, 0xB0}, 1},
    {"gravitar", {0x89, 0x88, 0x87}, 1},
    {"hero", {0xB9, 0xB8, 0xB7}, 1},
    {"jamesbond", {0xDC, 0xDD, 0xDE}, 1},
    {"journey_escape", {0x92, 0x91, 0x90}, 1},
    {"kangaroo", {0xA8, 0xA7}, 100},
    {"keystone_kapers", {0x9C, 0x9B}, 1},
    {"king_kong", {0x83, 0x82}, 1},
    {"koolaid", {0x81, 0x80}, 100},
    {"krull", {0x9E, 0x9D, 0x9C}, 1},
    {"kung_fu_master", {0x9A, 0x99, 0x98}, 1},
    {"laser_gates", {0x82, 0x81, 0x80}, 1},
    {"lost_luggage", {0x96, 0x95, 0x94}, 1},
    {"mario_bros", {0x8A, 0x89}, 100},
    {"montezuma_revenge", {0x95, 0x94, 0x93}, 1},
    {"mr_do", {0x82, 0x83}, 10},
    {"ms_pacman", {0xF8, 0xF9, 0xFA}, 1},
    {"name_this_game", {0xC6, 0xC5, 0xC4}, 1},
    {"pacman", {0xCC, 0xCE, 0xD0}, 1},
    {"pooyan", {0x8A, 0x89, 0x88}, 1},
    {"private_eye", {0xCA, 0xC9, 0xC8}, 1},
    {"qbert", {0xDB, 0xDA, 0xD9}, 1},
    {"seaquest", {0xBA, 0xB9, 0xB8}, 1},
    {"sir_lancelot", {0xA0, 0x9F, 0x9E}, 1},
    {"solaris", {0xDC, 0xDD, 0xDE}, 10},
    {"tetris", {0xF1, 0xF2}, 1},
    {"time_pilot", {0x8D, 0x8F}, 100},
    {"trondead", {0xBF, 0xBE, 0xBD}, 1},
    {"turmoil", {0x89, 0x8A}, 10},
    {"tutankham", {0x9C, 0x9A}, 1},
    {"up_n_down", {0x82, 0x81, 0x80}, 1},
    {"venture", {0xC8, 0xC7}, 100},
    {"video_pinball", {0xB0, 0xB2, 0xB4}, 1},
    {"yars_revenge", {0xE2, 0xE1, 0xE0}, 1},
    {"zaxxon", {0xE9, 0xE8}, 100},
};

// Scores in other formats: memory at the highest score and just after the wrap, and the gain.
struct OtherScore {
  const char* game;
  int modulus;
  std::vector<std::pair<int, int>> before, after;
  int gain;
};

const OtherScore kOtherScores[] = {
    {"alien",
     1000000,
     {{0x8B, 72}, {0x89, 72}, {0x87, 72}, {0x85, 72}, {0x83, 72}},
     {{0x8B, 8}, {0x89, 0}, {0x87, 0}, {0x85, 0}, {0x83, 0x80}},
     20},
    {"battle_zone", 1000000, {{0x9D, 0x90}, {0x9E, 0x99}}, {{0x9D, 0x20}, {0x9E, 0xAA}}, 3000},
    {"crazy_climber",
     1000000,
     {{0x82, 9}, {0x83, 9}, {0x84, 9}, {0x85, 9}},
     {{0x82, 4}, {0x83, 0}, {0x84, 0}, {0x85, 0}},
     500},
    {"defender",
     1000000,
     {{0x9C, 9}, {0x9D, 9}, {0x9E, 9}, {0x9F, 9}, {0xA0, 9}, {0xA1, 9}},
     {{0x9C, 9}, {0x9D, 4}, {0x9E, 1}, {0x9F, 10}, {0xA0, 10}, {0xA1, 10}},
     150},
    {"entombed", 256, {{0xE3, 255}}, {{0xE3, 0}}, 1},
    {"phoenix",
     1000000,
     {{0xC7, 0x90}, {0xC8, 0x99}, {0xC9, 0x99}},
     {{0xC7, 0x20}, {0xC8, 0}, {0xC9, 0}},
     30},
    {"riverraid",
     1000000,
     {{0xD7, 72}, {0xD5, 72}, {0xD3, 72}, {0xD1, 72}, {0xCF, 72}, {0xCD, 72}},
     {{0xD7, 72}, {0xD5, 40}, {0xD3, 0}, {0xD1, 0}, {0xCF, 0}, {0xCD, 0}},
     60},
    {"road_runner",
     1000000,
     {{0xC9, 9}, {0xCA, 9}, {0xCB, 9}, {0xCC, 9}},
     {{0xC9, 1}, {0xCA, 10}, {0xCB, 10}, {0xCC, 10}},
     200},
    {"star_gunner",
     1000000,
     {{0x83, 9}, {0x84, 9}, {0x85, 9}, {0x86, 9}},
     {{0x83, 1}, {0x84, 10}, {0x85, 10}, {0x86, 10}},
     200},
};

// Games with corrections other than a wrap; each has a test case below. Klax has its score in the cartridge's
// memory: environment/rules_test.cpp.
const std::set<std::string> kOthers = {"adventure", "backgammon", "basic_math", "blackjack",
                                       "breakout",  "casino",     "kaboom",     "klax",
                                       "pitfall",   "space_war",  "word_zapper"};

struct Frames {
  explicit Frames(std::shared_ptr<const Game> its_game) : game(std::move(its_game)), rule(*game) {}
  int operator()(const std::vector<std::pair<int, int>>& bytes) {
    for (const auto& [address, value] : bytes) memory[address] = static_cast<std::uint8_t>(value);
    rule.step(memory.memory());
    return rule.reward();
  }

  std::shared_ptr<const Game> game;
  FakeMemory memory;
  Rule rule;
};

// Goes through the middle, because a step from 0 to the highest score would itself be a wrap.
int reward_of_second(std::shared_ptr<const Game> game, const std::vector<std::pair<int, int>>& first,
                     const std::vector<std::pair<int, int>>& second) {
  Frames frames(std::move(game));
  auto middle = first;
  for (auto& [address, value] : middle) value /= 2;
  frames(middle);
  frames(first);
  return frames(second);
}

std::vector<std::pair<int, int>> all(const std::vector<int>& addresses, int value) {
  std::vector<std::pair<int, int>> bytes;
  for (const int address : addresses) bytes.emplace_back(address, value);
  return bytes;
}

// The reference's reward across the wrap: mostly the gain less the modulus.
bool is_wrong(int reward, int gain) { return reward < 0 || (reward == 0 && gain > 0); }

std::shared_ptr<const Game> fixed(const char* name) {
  const auto game = find_game(name);
  REQUIRE(game);
  REQUIRE(game->fixed);
  return game->fixed;
}

}  // namespace

TEST_CASE("a decimal score that wraps gives the points gained, and in the reference's rule does not") {
  for (const DecimalScore& score : kDecimalScores) {
    INFO(score.game);
    const auto before = all(score.addresses, 0x99);
    auto after = all(score.addresses, 0x00);
    after.front().second = 0x05;
    CHECK(reward_of_second(fixed(score.game), before, after) == 6 * score.unit);
    CHECK(is_wrong(reward_of_second(find_game(score.game), before, after), 6));
  }
}

TEST_CASE("scores kept in other ways wrap too") {
  for (const OtherScore& score : kOtherScores) {
    INFO(score.game);
    CHECK(reward_of_second(fixed(score.game), score.before, score.after) == score.gain);
    const int reference = reward_of_second(find_game(score.game), score.before, score.after);
    CHECK((reference == score.gain - score.modulus || reference == 0));
  }
}

TEST_CASE("away from the wrap a corrected rule gives what the reference's gives") {
  for (const DecimalScore& score : kDecimalScores) {
    INFO(score.game);
    const auto before = all(score.addresses, 0x11);
    auto after = before;
    after.front().second = 0x17;
    CHECK(reward_of_second(fixed(score.game), before, after) == 6 * score.unit);
    CHECK(reward_of_second(find_game(score.game), before, after) == 6 * score.unit);
  }
}

TEST_CASE("a score that is cleared is not a wrap") {
  const auto bytes = [](int value) { return all({0xBA, 0xB9, 0xB8}, value); };
  CHECK(reward_of_second(fixed("seaquest"), bytes(0x50), bytes(0)) == -505050);
}

TEST_CASE("every corrected rule has its test here") {
  std::set<std::string> tested = kOthers, corrected;
  for (const DecimalScore& score : kDecimalScores) tested.insert(score.game);
  for (const OtherScore& score : kOtherScores) tested.insert(score.game);
  for (const CatalogueEntry& entry : catalogue())
    if (find_game(entry.name)->fixed) corrected.insert(std::string(entry.name));
  CHECK(corrected == tested);
}

TEST_CASE("Dark Chambers goes on when its score wraps, and ends when it falls") {
  for (const bool mended : {false, true}) {
    Frames frames(mended ? fixed("darkchambers") : find_game("darkchambers"));
    frames({{0xCC, 0x50}, {0xCF, 0x50}, {0xCA, 5}});
    frames({{0xCC, 0x99}, {0xCF, 0x99}});
    frames({{0xCC, 0x00}, {0xCF, 0x00}});
    CHECK(frames.rule.terminal() == !mended);
    frames({{0xCC, 0x50}});
    frames({{0xCC, 0x20}});
    CHECK(frames.rule.terminal());
  }
}

TEST_CASE("Breakout and Video Pinball end when their counter begins anew, and not when it is cleared") {
  struct Counter {
    const char* game;
    int low, high;
  };
  for (const auto& [name, low, high] : {Counter{"breakout", 0xDA, 0xDB}, {"video_pinball", 0x9A, 0x9B}}) {
    INFO(name);
    for (const bool mended : {false, true}) {
      Frames frames(mended ? fixed(name) : find_game(name));
      frames({{0xB9, 5}, {low, 0xFF}, {high, 0xFF}});
      CHECK_FALSE(frames.rule.terminal());
      frames({{low, 0}, {high, 0}});
      CHECK(frames.rule.terminal() == mended);
      frames({{low, 1}});
      CHECK(frames.rule.terminal() == mended);
    }
    Frames frames(fixed(name));
    frames({{0xB9, 5}, {low, 0x20}, {high, 0xF0}});
    frames({{low, 0}, {high, 0}});
    CHECK_FALSE(frames.rule.terminal());
  }
}

TEST_CASE("Basic Math ends when nobody answers, and Space War when the fuel is used up") {
  for (const bool mended : {false, true}) {
    Frames math(mended ? fixed("basic_math") : find_game("basic_math"));
    math({{0x82, 1}});
    CHECK_FALSE(math.rule.terminal());
    math({{0x9A, 1}});
    CHECK(math.rule.terminal() == mended);

    Frames war(mended ? fixed("space_war") : find_game("space_war"));
    for (const auto& [fuel, ship] : {std::pair{9, 2}, {9, 0}, {16, 0}}) {
      war({{0x80, 0x7A}, {0xA8, fuel}, {0xA9, ship}});
      CHECK_FALSE(war.rule.terminal());
    }
    war({{0xA9, 2}});
    CHECK(war.rule.terminal() == mended);
  }
}

TEST_CASE("Pitfall ends at 0:00, once its clock has shown something else") {
  for (const bool mended : {false, true}) {
    Frames frames(mended ? fixed("pitfall") : find_game("pitfall"));
    frames({{0x80, 0xA0}, {0xD8, 0}, {0xD9, 0}});
    CHECK_FALSE(frames.rule.terminal());
    for (const auto& [minutes, seconds] : {std::pair{0x20, 0}, {0x01, 0}, {0, 0x01}}) {
      frames({{0xD8, minutes}, {0xD9, seconds}});
      CHECK_FALSE(frames.rule.terminal());
    }
    frames({{0xD9, 0}});
    CHECK(frames.rule.terminal() == mended);
    CHECK(frames.rule.lives() == (mended ? 0 : 3));
  }
}

TEST_CASE("Word Zapper and Casino give a reward once") {
  for (const bool mended : {false, true}) {
    Frames word(mended ? fixed("word_zapper") : find_game("word_zapper"));
    word({{0xCF, 1}, {0xDC, 2}, {0xDE, 9}});
    CHECK(word({{0xDC, 1}}) == 1);
    CHECK(word({{0xCF, 0}}) == (mended ? 0 : 1));

    Frames casino(mended ? fixed("casino") : find_game("casino"));
    casino({{0x95, 0x00}, {0x8C, 0x10}});
    CHECK(casino({{0x95, 0x50}}) == 50);
    CHECK(casino({{0xD3, 0x80}}) == (mended ? 0 : 50));
    CHECK(casino({{0x95, 0x20}}) == (mended ? -30 : 50));
    CHECK(casino({{0xD3, 0x00}}) == 0);
  }
}

struct Lives {
  const char* game;
  std::vector<std::pair<int, int>> bytes;
  int reference, mended;
};

TEST_CASE("corrected lives count the present one, and are 0 at the end only") {
  const Lives kLives[] = {
      {"kaboom", {{0xA1, 2}}, 1, 2},     {"kaboom", {{0xA1, 0}}, 0, 0},
      {"entombed", {{0xC7, 2}}, 1, 2},   {"entombed", {{0xC7, 0}}, 0, 0},
      {"bank_heist", {{0xD5, 0}}, 0, 1}, {"bank_heist", {{0xD5, 4}}, 4, 5},
      {"bank_heist", {{0xCE, 1}}, 0, 0}, {"donkey_kong", {{0xA3, 0}}, 0, 1},
      {"frogger", {{0xD0, 0}}, 0, 1},    {"frogger", {{0xD0, 0xFF}}, 0, 0},
      {"qbert", {{0x88, 0}}, 4, 4},      {"qbert", {{0x88, 0xFE}}, 0, 0},
      {"adventure", {{0xE0, 2}}, 1, 0},  {"adventure", {{0xE0, 0}}, 1, 1},
  };
  for (const Lives& row : kLives) {
    INFO(row.game);
    const auto reference = find_game(row.game);
    Frames before(reference), after(fixed(row.game));
    before(row.bytes);
    after(row.bytes);
    CHECK(before.rule.lives() == row.reference);
    CHECK(after.rule.lives() == row.mended);
  }
}

TEST_CASE("Q*bert's extra lives show, once the game has begun") {
  Frames reference(find_game("qbert")), mended(fixed("qbert"));
  for (const int value : {0, 2, 3, 2, 1}) {
    reference({{0x88, value}});
    mended({{0x88, value}});
    CHECK(mended.rule.lives() == (value == 0 ? 4 : value + 2));
  }
  CHECK(reference.rule.lives() == 2);
}

TEST_CASE("corrected minimal actions turn the paddle, or leave it alone") {
  for (const char* name : {"backgammon", "blackjack", "casino"}) {
    CHECK(fixed(name)->minimal_actions == std::vector<int>{0, 1, 3, 4});
    CHECK(find_game(name)->minimal_actions != std::vector<int>{0, 1, 3, 4});
  }
}
