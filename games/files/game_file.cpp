#include "games/files/game_file.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "emulator/cartridge/cartridge.hpp"
#include "games/files/game_lists.hpp"
#include "games/files/toml_section.hpp"
#include "games/game/property_overrides.hpp"
#include "games/language/rule_compiler.hpp"

namespace racebeam {
namespace {

constexpr int kLargestMode = 65535, kLargestDifficulty = 3;

// Images

constexpr std::size_t kMd5Length = 32;

bool is_md5(const std::string& text) {
  return text.size() == kMd5Length && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

template <typename Rows>
auto choice_of_section(const Section& section, std::string_view key, const Rows& rows) {
  const auto names = names_of(rows);
  const auto chosen = section.choice(key, {names.begin(), names.end()});
  return chosen ? std::optional(rows[*chosen].value) : std::nullopt;
}

Properties properties_of(const Section& section) {
  constexpr std::array<WordFor<Format>, 5> kFileFormats = {{{"auto", Format::kAuto},
                                                            {"NTSC", Format::kNtsc},
                                                            {"PAL", Format::kPal},
                                                            {"PAL60", Format::kPal60},
                                                            {"SECAM", Format::kSecam}}};
  const std::vector<std::string> difficulties = {"B", "A"};
  Properties properties;
  properties.left = choice_of_section(section, "left", kControllers).value_or(properties.left);
  properties.right = choice_of_section(section, "right", kControllers).value_or(properties.right);
  properties.swap_ports = section.flag("swap_ports").value_or(properties.swap_ports);
  properties.swap_paddles = section.flag("swap_paddles").value_or(properties.swap_paddles);
  properties.left_difficulty_a = section.choice("left_difficulty", difficulties) == 1;
  properties.right_difficulty_a = section.choice("right_difficulty", difficulties) == 1;
  properties.hmove_blanks = section.flag("hmove_blanks").value_or(properties.hmove_blanks);
  properties.format = choice_of_section(section, "format", kFileFormats).value_or(properties.format);
  if (const auto scheme = section.text("scheme"))
    section.guard(*section.node("scheme"), "scheme", [&] { properties.scheme = scheme_named(*scheme).name; });
  properties.ystart = section.number("ystart", 0, kLastYStart).value_or(properties.ystart);
  properties.height = section.number("height", kMinHeight, kMaxHeight).value_or(properties.height);
  return properties;
}

GameImage read_image(const TomlSource& source, const toml::table& table) {
  const Section section(source, table, "image");
  section.allow({"md5", "left", "right", "swap_ports", "swap_paddles", "left_difficulty", "right_difficulty",
                 "hmove_blanks", "format", "scheme", "ystart", "height", "accepted"});
  GameImage image{.md5 = section.text("md5").value_or(""),
                  .properties = properties_of(section),
                  .accepted = section.flag("accepted").value_or(true)};
  const int lines = image.properties.ystart + image.properties.height;
  if (lines > kPictureLines)
    section.refuse(table, "height",
                   "the sum of ystart and height is " + std::to_string(lines) + "; it must be at most " +
                       std::to_string(kPictureLines));
  if (table.contains("md5") && !is_md5(image.md5))
    section.refuse(*table.get("md5"), "md5", "must be 32 lower-case hexadecimal digits");
  return image;
}

std::vector<GameImage> read_images(const TomlSource& source, const Section& section) {
  std::vector<GameImage> images;
  const toml::array* list = section.list("image");
  if (!list) return images;
  for (const toml::node& node : *list) {
    if (!node.is_table()) section.refuse(node, "image", "must be tables: write [[image]]");
    images.push_back(read_image(source, *node.as_table()));
  }
  return images;
}

// Actions and modes

void read_default_mode(const Section& section, const toml::table& table, Game& game) {
  if (table.contains("two_player_modes"))
    game.two_player_modes = read_numbers(section, "two_player_modes", kLargestMode);
  game.default_mode = section.number("default_mode").value_or(game.modes.front());
  if (std::find(game.modes.begin(), game.modes.end(), game.default_mode) == game.modes.end())
    section.refuse(*table.get("default_mode"), "default_mode",
                   std::to_string(game.default_mode) + " is not one of the modes");
}

void read_minimal(const Section& section, const toml::table& table, Game& game) {
  game.minimal_actions = read_actions(section, "minimal", game.legal_actions);
  if (!std::ranges::includes(game.legal_actions, game.minimal_actions))
    section.refuse(*table.get("minimal"), "minimal", "must be legal actions");
}

void read_facts(const TomlSource& source, const Section& section, const toml::table& table, Game& game) {
  game.title = section.text("title").value_or("");
  if (game.title.empty()) section.refuse_missing("title", "a game must have this key");
  game.images = read_images(source, section);
  game.legal_actions = read_actions(section, "legal", all_actions());
  read_minimal(section, table, game);
  game.starting_actions = read_starting_actions(section, "start");
  game.modes = read_numbers(section, "modes", kLargestMode);
  read_default_mode(section, table, game);
  game.difficulties = read_numbers(section, "difficulties", kLargestDifficulty);
  game.paddle_max = section.number("paddle_max").value_or(-1);
  if (table.contains("paddle_max") && game.paddle_max < 1)
    section.refuse(*table.get("paddle_max"), "paddle_max",
                   std::to_string(game.paddle_max) + " is not a resistance in ohms, at least 1");
}

// Rule and mode program

void read_reset(const Section& section, const toml::table& table, RuleCompiler& compiler) {
  for (const auto& [key, node] : table) {
    const std::int32_t initial = *section.number(key.str());
    section.guard(node, key.str(), [&, name = key.str()] { compiler.reset_to(name, initial); });
  }
}

void read_keep(const Section& section, RuleCompiler& compiler) {
  const toml::array* list = section.list("keep");
  if (!list) return;
  for (const toml::node& node : *list)
    section.guard(node, "keep", [&] { compiler.keep(node.value_exact<std::string>().value_or("")); });
}

void read_answers(const Section& section, RuleCompiler& compiler) {
  const char* usual_lives = compiler.assigns("lives") ? "if(terminal, 0, lives)" : "if(terminal, 0, 1)";
  if (!section.node("terminal")) compiler.terminal("terminal");
  if (!section.node("lives")) compiler.lives(usual_lives);
  section.compile("terminal", [&](std::string_view source) { compiler.terminal(source); });
  section.compile("lives", [&](std::string_view source) { compiler.lives(source); });
}

// A variable that is set but never read is most likely misspelt.
constexpr const char* kUseless = "the step never reads this variable's previous value";

void refuse_useless_reset(const Section& section, const toml::table& reset, const RuleCompiler& compiler) {
  for (const auto& [key, node] : reset)
    if (!compiler.uses(key.str())) section.refuse(node, key.str(), kUseless);
}

void refuse_useless_keep(const Section& section, const RuleCompiler& compiler) {
  const toml::array* list = section.list("keep");
  if (!list) return;
  for (const toml::node& node : *list)
    if (!compiler.uses(*node.value_exact<std::string>())) section.refuse(node, "keep", kUseless);
}

std::optional<int> read_wraps(const Section& section) {
  const std::optional<int> modulus = section.number("wraps");
  if (modulus && *modulus < kMinModulus)
    section.refuse(
        *section.node("wraps"), "wraps",
        "must be at least " + std::to_string(kMinModulus) + ": the number at which the score starts again");
  return modulus;
}

// The mode program may read variables of the rule, so both are compiled together.
void read_rule(const Section& section, const TomlSource& source, const Section* mode, Game& game) {
  if (!section.node("step")) section.refuse_missing("step", "a rule must have this key");
  const toml::table none;
  const toml::table* reset = section.table("reset");
  if (!reset) reset = &none;
  const Section reset_section(source, *reset, "rule.reset");

  RuleCompiler compiler;
  if (const std::optional<int> modulus = read_wraps(section)) compiler.wraps(*modulus);
  read_reset(reset_section, *reset, compiler);
  read_keep(section, compiler);
  section.compile("step", [&](std::string_view text) { compiler.step(text); });
  read_answers(section, compiler);
  if (mode)
    mode->compile("setup", [&](std::string_view text) { game.mode_program = compiler.mode_program(text); });
  refuse_useless_reset(reset_section, *reset, compiler);
  refuse_useless_keep(section, compiler);
  game.rule = compiler.finish();
}

// Corrections

Correction read_correction(const Section& section, const toml::table& table) {
  Correction correction{.wraps = section.number("wraps"),
                        .reference = section.text("reference").value_or(""),
                        .correction = section.text("correction").value_or(""),
                        .evidence = section.text("evidence").value_or("")};
  const bool wraps_only = table.size() == 1 && correction.wraps;
  for (const char* key : {"reference", "correction", "evidence"})
    if (!wraps_only && section.text(key).value_or("").empty())
      section.refuse_missing(key, "a correction that has more than 'wraps' must have this key");
  return correction;
}

void read_fixed(const TomlSource& source, const toml::table& rule, const toml::table& table,
                const Section* mode, Game& game) {
  const Section section(source, table, "fixed"), merged(source, table, "fixed", &rule);
  section.allow({"wraps", "step", "reset", "keep", "terminal", "lives", "minimal", "reference", "correction",
                 "evidence"});
  Game fixed = game;
  read_rule(merged, source, mode, fixed);
  if (table.contains("minimal")) read_minimal(section, table, fixed);
  game.correction = read_correction(section, table);
  fixed.correction = game.correction;
  fixed.is_fixed = true;
  game.fixed = std::make_shared<const Game>(std::move(fixed));
}

// ALE 0.6

Game facts_of_classic(const Section& section, const toml::table& table, Game game) {
  if (table.contains("start")) game.starting_actions = read_starting_actions(section, "start");
  if (section.flag("single_mode").value_or(false)) {
    game.modes = {game.default_mode};
    game.two_player_modes.clear();
    game.mode_program = {};
  }
  return game;
}

void read_classic(const TomlSource& source, const toml::table& rule, const toml::table& table,
                  const Section* mode, Game& game) {
  const Section section(source, table, "classic"), merged(source, table, "classic", &rule);
  section.allow({"start", "single_mode", "step", "reset", "keep", "terminal", "lives"});
  Game ruled = game;
  read_rule(merged, source, mode, ruled);
  Game classic = facts_of_classic(section, table, std::move(ruled));
  if (game.fixed) classic.fixed = std::make_shared<const Game>(facts_of_classic(section, table, *game.fixed));
  game.classic = std::make_shared<const Game>(std::move(classic));
}

constexpr std::array<WordFor<RuleSource>, 2> kRuleSources = {
    {{"ale-0.12", RuleSource::kAle012}, {"racebeam", RuleSource::kRacebeam}}};

// [rule], [fixed], [classic] and [mode]
void read_rules(const TomlSource& source, const Section& section, Game& game) {
  const toml::table* const rule = section.table("rule");
  const toml::table* const fixed = section.table("fixed");
  const toml::table* const classic = section.table("classic");
  const toml::table* const mode = section.table("mode");
  std::optional<Section> setup;
  if (mode) setup.emplace(source, *mode, "mode").allow({"setup"});
  if (!rule && mode) section.refuse(*mode, "mode", "a mode program requires a [rule]");
  if (!rule && fixed) section.refuse(*fixed, "fixed", "a correction requires a [rule]");
  if (!rule && classic) section.refuse(*classic, "classic", "a classic rule requires a [rule]");
  if (!rule) return;
  const Section rule_section(source, *rule, "rule");
  rule_section.allow({"step", "reset", "keep", "terminal", "lives", "wraps", "source"});
  game.rule_source = choice_of_section(rule_section, "source", kRuleSources).value_or(RuleSource::kAle012);
  read_rule(rule_section, source, setup ? &*setup : nullptr, game);
  if (fixed) read_fixed(source, *rule, *fixed, setup ? &*setup : nullptr, game);
  if (classic) read_classic(source, *rule, *classic, setup ? &*setup : nullptr, game);
}

}  // namespace

Game parse_game(std::string_view text, const std::string& name, const std::string& file) {
  const TomlSource source{text, file};
  const toml::table table = parse_toml(source);
  const Section section(source, table, "");
  section.allow({"title", "legal", "minimal", "start", "modes", "two_player_modes", "default_mode",
                 "difficulties", "paddle_max", "image", "rule", "fixed", "classic", "mode"});
  Game game;
  game.name = name;
  read_facts(source, section, table, game);
  read_rules(source, section, game);
  return game;
}

}  // namespace racebeam
