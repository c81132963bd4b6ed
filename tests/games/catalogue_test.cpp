#include <catch2/catch.hpp>

#include <algorithm>
#include <filesystem>
#include <set>

#include "games/catalogue.hpp"

using namespace racebeam;

constexpr int kGamesOfReference = 104;  // tests/docs/test_game_facts.py compares them with the specification

TEST_CASE("the catalogue has all games, in order, each name once") {
  const auto games = catalogue();
  CHECK(std::ranges::is_sorted(games, std::ranges::less{}, &CatalogueEntry::name));
  CHECK(std::ranges::adjacent_find(games, {}, &CatalogueEntry::name) == games.end());
  const auto has_rule_of_reference = [](const CatalogueEntry& entry) {
    return entry.has_rule && !entry.built_in && find_game(entry.name)->rule_source == RuleSource::kAle012;
  };
  CHECK(std::ranges::count_if(games, has_rule_of_reference) == kGamesOfReference);
  // The reference knows only the MD5 of their images.
  for (const std::string name : {"combat", "joust", "maze_craze", "warlords"})
    CHECK(find_game(name)->rule_source == RuleSource::kRacebeam);
}

TEST_CASE("the catalogue is what lies in its folder") {
  std::set<std::string> files, names;
  for (const auto& entry : std::filesystem::directory_iterator(RACEBEAM_SOURCE_DIR "/games/catalogue"))
    if (entry.path().extension() == ".toml") files.insert(entry.path().stem().string());
  for (const CatalogueEntry& entry : catalogue()) names.insert(std::string(entry.name));
  CHECK(files == names);
}

TEST_CASE("every game file can be read and is sound") {
  for (const CatalogueEntry& entry : catalogue()) {
    INFO(entry.name);
    const auto game = find_game(entry.name);
    REQUIRE(game);
    CHECK(game->name == entry.name);
    CHECK(game->title == entry.title);
    CHECK(game->has_rule() == entry.has_rule);
    CHECK(std::ranges::is_sorted(game->legal_actions));
    CHECK(std::ranges::is_sorted(game->minimal_actions));
    CHECK(std::ranges::includes(game->legal_actions, game->minimal_actions));
    CHECK(std::ranges::find(game->modes, game->default_mode) != game->modes.end());
    CHECK(std::set<int>(game->modes.begin(), game->modes.end()).size() == game->modes.size());
    for (const GameImage& image : game->images) CHECK((image.md5.size() == 32 || entry.built_in));
    CHECK((entry.built_in || !game->images.empty()));
  }
}

TEST_CASE("every accepted image leads to its game by its MD5, and no other does") {
  CHECK(std::ranges::is_sorted(catalogue_images(), std::ranges::less{}, &CatalogueImage::md5));
  std::size_t accepted = 0;
  for (const CatalogueImage& image : catalogue_images()) {
    const auto game = find_game_by_md5(image.md5);
    REQUIRE((game != nullptr) == image.accepted);
    if (game) CHECK(game->name == catalogue()[image.entry].name);
    accepted += image.accepted ? 1 : 0;
  }
  CHECK(accepted >= 108);
  CHECK(find_game_by_md5("00000000000000000000000000000000") == nullptr);
  CHECK(find_game_by_md5("") == nullptr);
}

TEST_CASE("a game's facts are those of its file") {
  const auto skiing = find_game("skiing");
  CHECK(skiing->legal_actions == std::vector<int>{0, 2, 3, 4, 5, 6, 7, 8, 9});
  CHECK(skiing->starting_actions == std::vector<int>(16, 5));
  CHECK(find_game("keystone_kapers")->starting_actions == std::vector<int>{kResetAction});
  CHECK(find_game("bank_heist")->modes == std::vector<int>{0, 4, 8, 12, 16, 20, 24, 28});
  CHECK(find_game("video_cube")->modes.size() == 153);
  CHECK(find_game("name_this_game")->default_mode == 8);
  CHECK(find_game("backgammon")->difficulties == std::vector<int>{3});
  CHECK(find_game("backgammon")->paddle_max == 1000000);
  CHECK(find_game("pong")->paddle_max == -1);
  CHECK(find_game("seaquest")->minimal_actions.size() == 18);
  CHECK(find_game("nobody") == nullptr);
}

TEST_CASE("the console's properties belong to the image") {
  const std::string pong_image = "60e0ea3cbe0913d39803477945e9e5ec";
  const Properties pong = find_game("pong")->properties_for(pong_image);
  CHECK(pong.left == Controller::kPaddles);
  CHECK(pong.right == Controller::kPaddles);
  CHECK(pong.swap_paddles);
  CHECK(find_game("pong")->properties_for("00000000000000000000000000000000") == Properties{});

  const auto road_runner = find_game("road_runner");
  CHECK(road_runner->properties_for("7d3cdde63b16fa637c4484e716839c94").ystart == 20);
  CHECK(road_runner->properties_for("ce5cc62608be2cd3ed8abd844efb8919") == Properties{});
  CHECK_FALSE(road_runner->accepts("7d3cdde63b16fa637c4484e716839c94"));
  CHECK(find_game("maze_craze")->properties_for("ed2218b3075d15eaa34e3356025ccca3").format == Format::kPal);
}

TEST_CASE("action names and numbers belong together") {
  for (int action = 0; action < kActionNumbers; ++action)
    if (is_action(action)) CHECK(action_number(action_name(action)) == action);
  CHECK(action_name(17) == "DOWNLEFTFIRE");
  CHECK(action_name(kResetAction) == "RESET");
  CHECK(action_name(kBlackAndWhiteAction) == "BW");
  CHECK(action_name(kFirstKey) == "KEY1");
  CHECK(action_name(kFirstKey + kKeys - 1) == "KEYHASH");
  CHECK(action_name(kFirstKey + kKeys).empty());
  CHECK(action_name(kWithC + 1) == "FIRE+C");
  CHECK(action_name(kWithBoth + 17) == "DOWNLEFTFIRE+TRIGGER+BOOSTER");
  CHECK(action_name(kWithC + kActions).empty());
  CHECK(action_name(kActionNumbers).empty());
  CHECK_FALSE(action_number(""));
  CHECK(action_name(kReferenceReset).empty());
  CHECK(action_name(-1).empty());
  CHECK_FALSE(action_number("JUMP"));
  CHECK_FALSE(action_number(""));
}
