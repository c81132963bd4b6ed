#include "cli/commands/games.hpp"

#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/arguments/subcommand.hpp"
#include "games/catalogue.hpp"

namespace racebeam {
namespace {

constexpr auto kGamesFooter =
    R"(NAME is the name for --game. An image is recognised by its MD5, else by the name of its file.
* marks a game whose image is part of this program: --rom builtin:NAME plays it.
SCORE says whether there is a rule that computes score and end from the game's memory. ACT. is the number of
actions in the minimal and in the legal set. MODES are those of one player; --rules lists those of two.

With --rules, RULE is the origin of the rule, B says whether player B gets rewards, and 2P MODES are the game
variations in which both play. FIXED is what --rules fixed corrects in the rule of ALE 0.12; docs/rules.md
gives the reasons.

Examples:
  racebeam games | grep -i pong
  racebeam games --rules | grep -i wrap
  racebeam games --json | jq '.[] | select(.name == "pong").modes')";

// Writes 0 1 2 3 8 as 0-3 8.
std::string ranges(const std::vector<int>& numbers) {
  std::string text;
  for (std::size_t first = 0, last = 0; first < numbers.size(); first = last + 1) {
    for (last = first; last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1;) ++last;
    text += (text.empty() ? "" : " ") + std::to_string(numbers[first]);
    if (last > first) text += '-' + std::to_string(numbers[last]);
  }
  return text;
}

std::string recognised_md5(const Game& game) {
  for (const GameImage& image : game.images) {
    if (image.accepted && !image.md5.empty()) return image.md5;
  }
  return "-";
}

void print_row(const CatalogueEntry& entry, const Game& game) {
  const std::string actions =
      std::to_string(game.minimal_actions.size()) + "/" + std::to_string(game.legal_actions.size());
  std::printf("%-20s%c %-34s %-32s %-5s  %-5s %-12s %s\n", game.name.c_str(), entry.built_in ? '*' : ' ',
              game.title.c_str(), recognised_md5(game).c_str(), game.has_rule() ? "yes" : "no",
              actions.c_str(), ranges(game.difficulties).c_str(), ranges(game.modes).c_str());
}

void print_table() {
  std::printf("%-20s  %-34s %-32s %-5s  %-5s %-12s %s\n", "NAME", "TITLE", "MD5", "SCORE", "ACT.",
              "DIFFICULTIES", "MODES");
  for (const CatalogueEntry& entry : catalogue()) print_row(entry, *find_game(entry.name));
}

std::string correction(const Game& game) {
  if (!game.fixed) return "-";
  const Correction& made = game.correction;
  std::string text = made.wraps ? "The score may wrap at " + std::to_string(*made.wraps) + "." : "";
  return text + (text.empty() || made.correction.empty() ? "" : " ") + made.correction;
}

const char* rule_name(const Game& game) {
  if (!game.has_rule()) return "-";
  return game.rule_source == RuleSource::kRacebeam ? "racebeam" : "ale-0.12";
}

void print_rules() {
  std::printf("%-20s %-9s %-3s %-24s %s\n", "NAME", "RULE", "B", "2P MODES", "FIXED");
  for (const CatalogueEntry& entry : catalogue()) {
    const auto game = find_game(entry.name);
    const std::string modes = game->two_player_modes.empty() ? "-" : ranges(game->two_player_modes);
    std::printf("%-20s %-9s %-3s %-24s %s\n", game->name.c_str(), rule_name(*game),
                game->has_second_reward() ? "yes" : "no", modes.c_str(), correction(*game).c_str());
  }
}

std::vector<std::string> names(const std::vector<int>& actions) {
  std::vector<std::string> words;
  for (const int action : actions) words.emplace_back(action_name(action));
  return words;
}

nlohmann::ordered_json images(const Game& game) {
  auto rows = nlohmann::ordered_json::array();
  for (const GameImage& image : game.images) {
    if (!image.md5.empty()) rows.push_back({{"md5", image.md5}, {"recognised", image.accepted}});
  }
  return rows;
}

nlohmann::ordered_json fixed_rule(const Game& game) {
  if (!game.fixed) return nullptr;
  const Correction& made = game.correction;
  return {{"wraps", made.wraps ? nlohmann::ordered_json(*made.wraps) : nullptr},
          {"reference", made.reference},
          {"correction", made.correction},
          {"evidence", made.evidence},
          {"minimal_actions", names(game.fixed->minimal_actions)}};
}

nlohmann::ordered_json as_json(const CatalogueEntry& entry) {
  const auto game = find_game(entry.name);
  return {
      {"name", game->name},
      {"title", game->title},
      {"images", images(*game)},
      {"built_in", entry.built_in},
      {"has_rule", game->has_rule()},
      {"rule", game->has_rule() ? nlohmann::ordered_json(rule_name(*game)) : nullptr},
      {"fixed", fixed_rule(*game)},
      {"second_reward", game->has_second_reward()},
      {"minimal_actions", names(game->minimal_actions)},
      {"legal_actions", names(game->legal_actions)},
      {"modes", game->modes},
      {"two_player_modes", game->two_player_modes},
      {"default_mode", game->default_mode},
      {"difficulties", game->difficulties},
  };
}

void print_json() {
  auto rows = nlohmann::ordered_json::array();
  for (const CatalogueEntry& entry : catalogue()) rows.push_back(as_json(entry));
  std::cout << rows.dump(1) << '\n';
}

}  // namespace

void add_games(Subcommand& program) {
  const auto json = std::make_shared<bool>(false), rules = std::make_shared<bool>(false);
  Subcommand command = program.add_subcommand("games", "List the games of the catalogue", kGamesFooter);
  const Option as_array = command.flag("--json", *json, "Print a JSON array instead of a table");
  command.flag("--rules", *rules, "Print the origin of each rule, and what --rules fixed corrects")
      .excludes(as_array);
  command.runs([json, rules] { *json ? print_json() : *rules ? print_rules() : print_table(); });
}

}  // namespace racebeam
