// games, load, settings, set, modes, difficulties, actions, names
#include <algorithm>
#include <utility>

#include "emulator/cartridge/cartridge.hpp"
#include "emulator/tia/registers/register_values.hpp"
#include "games/similar.hpp"
#include "protocol/encoding/base64.hpp"
#include "protocol/line/play_settings.hpp"
#include "protocol/line/session.hpp"
#include "protocol/line/session_recording.hpp"
#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

constexpr std::string_view kInline = "inline";

template <typename Names>
void append_names(std::string& out, const Names& names) {
  append_pair(out, "count", static_cast<std::int64_t>(names.size()));
  append_pair(out, "games", "");
  for (std::size_t i = 0; i < names.size(); ++i) (out += i > 0 ? "," : "") += names[i];
}

void append_numbered(std::string& out, std::string_view key, const std::vector<int>& numbers) {
  append_pair(out, key, "");
  append_list(out, numbers);
}

template <typename List>
void append_words(std::string& out, std::string_view key, const List& words) {
  append_pair(out, key, "");
  std::string_view separator;
  for (const auto& word : words) {
    out.append(separator).append(word);
    separator = ",";
  }
}

std::string_view format_name(Format format) { return kFormatNames[static_cast<std::size_t>(format)]; }

[[noreturn]] void refuse_game(const Images& images, std::string_view name) {
  if (find_game(name)) {
    throw RequestError(ErrorCode::kUnknownGame,
                       "the image of " + std::string(name) +
                           " is not here; games lists those that are; load inline takes one");
  }
  std::string meant = did_you_mean(name, images.names());
  if (meant.empty()) meant = did_you_mean(name, game_names());
  throw RequestError(
      ErrorCode::kUnknownGame,
      "there is no game " + quote(name) + ';' + (meant.empty() ? " games lists those that are here" : meant));
}

void append_console(std::string& out, const Cartridge& cartridge) {
  const Properties properties = cartridge.game->properties_for(cartridge.image->md5);
  append_pair(out, "scheme", scheme_word(scheme_of(*cartridge.image->bytes, properties.scheme).name));
  append_pair(out, "left", name_of(properties.left));
  append_pair(out, "right", name_of(properties.right));
}

void describe_game(Session& session, std::string_view name) {
  const Cartridge* cartridge = session.service.images->find(name);
  const auto game = cartridge ? cartridge->game : find_game(name);
  if (!game) refuse_game(*session.service.images, name);
  std::string& out = session.out;
  out += "ok";
  append_pair(out, "game", game->name);
  append_pair(out, "here", cartridge != nullptr);
  if (cartridge) append_pair(out, "md5", cartridge->image->md5);
  if (cartridge) append_console(out, *cartridge);
  append_pair(out, "rule", game->has_rule());
  append_numbered(out, "modes", game->modes);
  append_numbered(out, "two_player_modes", game->two_player_modes);
  append_numbered(out, "difficulties", game->difficulties);
  append_numbered(out, "minimal", game->minimal_actions);
  append_numbered(out, "legal", game->legal_actions);
}

constexpr std::array<std::string_view, 2> kKeysOfImages = {"image", "as"};
constexpr std::array<std::string_view, 2> kKeysOfSet = {"mode", "difficulty"};

// The words of `load` after the name of the game.
struct LoadWords {
  std::optional<std::string_view> image, as;
  std::vector<std::string_view> settings;
};

// Stops after more words than there are settings: one of them is refused, since it is unknown or there twice.
LoadWords sorted(Words words) {
  LoadWords load;
  for (const std::string_view word : words) {
    if (load.settings.size() > setting_rows().size()) break;
    const auto [key, value] = key_value(word);
    if (key == "image") {
      if (load.image) refuse_twice(key);
      load.image = value;
    } else if (key == "as") {
      if (load.as) refuse_twice(key);
      load.as = value;
    } else {
      load.settings.push_back(word);
    }
  }
  return load;
}

std::shared_ptr<const Image> sent_image(Session& session, const LoadWords& words) {
  if (!words.image) throw RequestError(ErrorCode::kBadArguments, "load inline needs image=BASE64");
  session.memory.check(words.image->size() / 4 * 3, "an image");
  auto bytes = bytes_of_base64(*words.image);
  if (!bytes)
    throw RequestError(ErrorCode::kBadImage, "the image is not base64 (A-Z a-z 0-9 + / and = at the end)");
  try {
    return make_image(std::move(*bytes), std::string(kInline));
  } catch (const InvalidInput& error) {
    throw RequestError(ErrorCode::kBadImage, error.what());
  }
}

Cartridge find_cartridge(Session& session, std::string_view name, const LoadWords& words) {
  Cartridge cartridge;
  if (name == kInline) {
    cartridge.image = sent_image(session, words);
  } else {
    if (words.image) throw RequestError(ErrorCode::kBadArguments, "image= goes with load inline");
    const Cartridge* found = session.service.images->find(name);
    if (found == nullptr) refuse_game(*session.service.images, name);
    cartridge = *found;
  }
  if (words.as) {
    const auto rules = session.service.images->rules(*words.as);
    if (!rules)
      throw RequestError(ErrorCode::kUnknownGame, "there are no rules for " + quote(*words.as) + ';' +
                                                      did_you_mean(*words.as, game_names()) +
                                                      " games all lists those that there are");
    cartridge.game = recognise_as(*cartridge.image, rules).game;
  } else if (name == kInline) {
    cartridge.game = recognise(*cartridge.image).game;
  }
  if (const auto known = session.service.images->same(*cartridge.image)) cartridge.image = known;
  return cartridge;
}

// Says why another mode than the wished one was set up: a machine begins in the default mode.
std::string with_wished_mode(std::string sentence, const PlaySettings& settings, const Cartridge& cartridge) {
  if (!settings.mode || !cartridge.game) return sentence;
  const std::string first = std::to_string(cartridge.game->default_mode);
  if (!sentence.starts_with("mode " + first + " of ") || *settings.mode == cartridge.game->default_mode)
    return sentence;
  return sentence + "; a machine begins in mode " + first + ", the default, before it takes mode " +
         std::to_string(*settings.mode);
}

void append_loaded(Session& session) {
  const Environment& machine = session.loaded->machine();
  std::string& out = session.out;
  out += "ok";
  append_pair(out, "game", machine.game().name);
  append_pair(out, "md5", machine.image().md5);
  append_pair(out, "rule", machine.game().has_rule());
  if (!doubt_about(machine.game(), machine.image()).empty()) append_pair(out, "image", "other");
  append_pair(out, "width", kScreenWidth);
  append_pair(out, "height", machine.height());
  append_pair(out, "format", format_name(machine.format()));
  append_settings(out, session.settings, machine);
}

}  // namespace

void run_games(Session& session, Words arguments) {
  if (!arguments.empty() && arguments[0] != "all") return describe_game(session, arguments[0]);
  session.out += "ok";
  if (arguments.empty()) return append_names(session.out, session.service.images->names());
  append_names(session.out, game_names());
}

// All or nothing: a refused load leaves the previous game running.
void run_load(Session& session, Words arguments) {
  const LoadWords words = sorted(arguments.subspan(1));
  PlaySettings settings;
  settings.machine.cpu = session.service.cpu;
  read_settings(words.settings, settings, kKeysOfImages);
  if (shows_audio(session.fields) && !settings.machine.sound)
    throw RequestError(ErrorCode::kBadArguments,
                       "observe selects audio, which needs sound=1; load with it, or observe other fields");
  if (settings.machine.random_seed == 0) settings.machine.random_seed = parse_seed("random");
  // The cache of resets belongs to the process, and would keep the image when the session is gone.
  Cartridge cartridge = find_cartridge(session, arguments[0], words);
  cartridge.game = with_given(cartridge.game, *cartridge.image, settings.console);
  std::unique_ptr<CodeOwner> own_image;
  if (session.service.images->same(*cartridge.image) == nullptr)
    own_image = std::make_unique<CodeOwner>(cartridge.image->bytes);
  settings.machine.copy_resets = own_image == nullptr;
  std::unique_ptr<LoadedMachine> loaded;
  try {
    session.allow_resets(1);
    session.memory.check(LoadedMachine::most_held(session.fields) + View::longest_text(session.fields),
                         "a machine");
    loaded = std::make_unique<LoadedMachine>(cartridge, settings, session.fields, session.pacer);
  } catch (const InvalidInput& error) {
    const bool sent = arguments[0] == kInline && !settings.mode && !settings.difficulty;
    throw RequestError(sent ? ErrorCode::kBadImage : ErrorCode::kBadValue,
                       with_wished_mode(error.what(), settings, cartridge));
  }
  session.recording.reset();
  session.machines.close();
  session.discard(session.states, session.states.footprint());
  session.loaded = std::move(loaded);
  session.cartridge = std::move(cartridge);
  session.own_image = std::move(own_image);
  session.settings = settings;
  session.episode = 1;
  session.last_action = 0;
  if (session.service.share_all && !session.sharing)
    session.sharing = Sharing::open_next(session.service.shares, kUsualWatchers);
  append_loaded(session);
}

void run_settings(Session& session, Words) { append_loaded(session); }

void run_set(Session& session, Words arguments) {
  PlaySettings changed;
  for (const std::string_view word : arguments) {
    const std::string_view key = key_value(word).key;
    if (std::ranges::find(kKeysOfSet, key) != kKeysOfSet.end()) continue;
    throw RequestError(ErrorCode::kBadArguments,
                       quote(key) + " can't be set while a game runs;" +
                           advice(key, kKeysOfSet, "there are mode and difficulty; load takes the others"));
  }
  read_settings(arguments, changed);
  Environment& machine = session.loaded->machine();
  const int mode = machine.mode();
  if (changed.mode) machine.set_mode(*changed.mode);
  try {
    if (changed.difficulty) machine.set_difficulty(*changed.difficulty);
  } catch (...) {
    machine.set_mode(mode);
    throw;
  }
  if (changed.mode) session.settings.mode = changed.mode;
  if (changed.difficulty) session.settings.difficulty = changed.difficulty;
  session.out += "ok";
  append_pair(session.out, "mode", machine.mode());
  append_pair(session.out, "difficulty", machine.difficulty());
}

void run_modes(Session& session, Words) {
  const Environment& machine = session.loaded->machine();
  session.out += "ok";
  append_pair(session.out, "mode", machine.mode());
  append_pair(session.out, "default", machine.game().default_mode);
  append_numbered(session.out, "modes", machine.game().modes);
  append_numbered(session.out, "two_player_modes", machine.game().two_player_modes);
}

void run_difficulties(Session& session, Words) {
  const Environment& machine = session.loaded->machine();
  session.out += "ok";
  append_pair(session.out, "difficulty", machine.difficulty());
  append_pair(session.out, "default", 0);
  append_numbered(session.out, "difficulties", machine.game().difficulties);
}

void run_actions(Session& session, Words) {
  const Game& game = session.loaded->machine().game();
  std::string& out = session.out;
  out += "ok";
  append_pair(out, "action_set", name_of(session.settings.action_set));
  append_pair(out, "actions", "");
  bool first = true;
  for (const int action : actions_of(session.settings.action_set, game)) {
    if (!std::exchange(first, false)) out += ',';
    append_number(out, std::int64_t{action});
    (out += ':') += action_name(action);
  }
  append_numbered(out, "minimal", game.minimal_actions);
  append_numbered(out, "legal", game.legal_actions);
}

void run_names(Session& session, Words) {
  const Game& game = session.loaded->machine().game();
  std::vector<std::string> bytes;
  if (game.rule)
    for (const auto& [index, name] : game.rule->bytes) bytes.push_back(std::to_string(index) + ':' + name);
  session.out += "ok";
  append_words(session.out, "ram_names", bytes);
  append_words(session.out, "tia_names", kTiaValueNames);
}

}  // namespace racebeam
