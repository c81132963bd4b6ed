#include "cli/commands/games.hpp"

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "cli/arguments/subcommand.hpp"
#include "games/catalogue.hpp"
#include "system/folded.hpp"
#include "system/similar.hpp"
#include "system/words.hpp"

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

With GAME, one game: the names of its actions, its controllers, and where its rule comes from.

Examples:
  racebeam games pong
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
  const Correction& correction = game.correction;
  std::string text =
      correction.wraps ? "The score may wrap at " + std::to_string(*correction.wraps) + "." : "";
  return text + (text.empty() || correction.correction.empty() ? "" : " ") + correction.correction;
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
  const Correction& correction = game.correction;
  return {{"wraps", correction.wraps ? nlohmann::ordered_json(*correction.wraps) : nullptr},
          {"reference", correction.reference},
          {"correction", correction.correction},
          {"evidence", correction.evidence},
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

// All games, or the one of this name.
void print_json(const std::string& name) {
  auto rows = nlohmann::ordered_json::array();
  for (const CatalogueEntry& entry : catalogue())
    if (name.empty() || entry.name == name) rows.push_back(as_json(entry));
  std::cout << rows.dump(1) << '\n';
}

const CatalogueEntry& entry_named(const std::string& name) {
  const auto found = std::ranges::find(catalogue(), name, &CatalogueEntry::name);
  if (found != catalogue().end()) return *found;
  const std::string suggestion = did_you_mean(name, game_names());
  throw std::invalid_argument("unknown game '" + name + "';" +
                              (suggestion.empty() ? " racebeam games lists them" : suggestion));
}

void print_fact(std::string_view name, const std::string& fact) {
  constexpr std::size_t kColumns = 100, kIndent = 14;
  std::string line(name);
  line.resize(kIndent, ' ');
  append_folded(line, fact, kColumns, kIndent, kIndent);
  std::cout << line << '\n';
}

std::string console_of(const Game& game) {
  const Properties properties = game.properties_for(recognised_md5(game));
  const std::string scheme(properties.scheme), format(name_of(properties.format));
  return std::string(name_of(properties.left)) + " on the left, " + std::string(name_of(properties.right)) +
         " on the right; scheme " + (scheme.empty() ? "auto" : scheme) + ", format " + format;
}

std::string modes_of(const Game& game) {
  const std::string two =
      game.two_player_modes.empty() ? "" : "; of two players: " + ranges(game.two_player_modes);
  return ranges(game.modes) + two + " (default " + std::to_string(game.default_mode) + ")";
}

std::string rule_of(const Game& game) {
  if (!game.has_rule()) return "unknown: neither score nor end";
  const std::string whose = game.rule_source == RuleSource::kRacebeam ? "racebeam's own" : "that of ALE 0.12";
  return whose + (game.has_second_reward() ? "; player B gets rewards, too" : "");
}

void print_game(const CatalogueEntry& entry) {
  const auto game = find_game(entry.name);
  print_fact("name", game->name + ": " + game->title);
  print_fact("image", "MD5 " + recognised_md5(*game) + (entry.built_in ? ", part of this program" : ""));
  print_fact("console", console_of(*game));
  print_fact("modes", modes_of(*game));
  print_fact("difficulties", ranges(game->difficulties) + " (default 0)");
  print_fact("minimal", join(names(game->minimal_actions), " "));
  print_fact("legal", join(names(game->legal_actions), " "));
  print_fact("rule", rule_of(*game));
  if (game->fixed) print_fact("rules fixed", correction(*game));
}

struct GamesOptions {
  std::string name;
  bool json = false, rules = false;
};

void print(const GamesOptions& options) {
  const CatalogueEntry* const one = options.name.empty() ? nullptr : &entry_named(options.name);
  if (options.json) return print_json(options.name);
  if (one) return print_game(*one);
  options.rules ? print_rules() : print_table();
}

}  // namespace

void add_games(Subcommand& program) {
  const auto options = std::make_shared<GamesOptions>();
  Subcommand command =
      program.add_subcommand("games", "List the games of the catalogue, or describe one", kGamesFooter);
  const Option name = command.option("GAME", options->name, "Describe only this game");
  const Option as_array = command.flag("--json", options->json, "Print a JSON array instead of a table");
  command.flag("--rules", options->rules, "Print the origin of each rule, and what --rules fixed corrects")
      .excludes(as_array)
      .excludes(name);
  command.runs([options] { print(*options); });
}

}  // namespace racebeam
