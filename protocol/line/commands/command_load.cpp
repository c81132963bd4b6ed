// games, load, settings, set, modes, difficulties, actions, names
#include <algorithm>
#include <utility>

#include "emulator/cartridge/cartridge.hpp"
#include "emulator/tia/registers/register_values.hpp"
#include "environment/settings/play_settings.hpp"
#include "protocol/encoding/base64.hpp"
#include "protocol/line/context.hpp"
#include "protocol/line/reply.hpp"
#include "protocol/line/session_log.hpp"
#include "protocol/line/session_recording.hpp"
#include "protocol/request_error.hpp"
#include "system/invalid_input.hpp"
#include "system/similar.hpp"

namespace racebeam {
namespace {

constexpr std::string_view kInline = "inline";

template <typename Names>
void add_names(Reply& reply, const Names& names) {
  reply.add("count", static_cast<std::int64_t>(names.size()));
  reply.add_list("games", names);
}

[[noreturn]] void refuse_game(const Images& images, std::string_view name) {
  if (find_game(name)) {
    throw RequestError(ErrorCode::kUnknownGame,
                       "the image of " + std::string(name) +
                           " is missing; games lists the available games, and load inline accepts an image");
  }
  std::string similar = did_you_mean(name, images.names());
  if (similar.empty()) similar = did_you_mean(name, game_names());
  throw RequestError(
      ErrorCode::kUnknownGame,
      "unknown game " + quote(name) + ';' + (similar.empty() ? " games lists the available games" : similar));
}

void add_console(Reply& reply, const Cartridge& cartridge) {
  const Properties properties = cartridge.game->properties_for(cartridge.image->md5);
  reply.add("scheme", scheme_word(scheme_of(*cartridge.image->bytes, properties.scheme).name));
  reply.add("left", name_of(properties.left));
  reply.add("right", name_of(properties.right));
}

void describe_game(const Context& context, std::string_view name, Reply& reply) {
  const Cartridge* cartridge = context.service.images->find(name);
  const auto game = cartridge ? cartridge->game : find_game(name);
  if (!game) refuse_game(*context.service.images, name);
  reply.add("game", game->name);
  reply.add("here", cartridge != nullptr);
  if (cartridge) reply.add("md5", cartridge->image->md5);
  if (cartridge) add_console(reply, *cartridge);
  reply.add("rule", game->has_rule());
  reply.add("modes", game->modes);
  reply.add("two_player_modes", game->two_player_modes);
  reply.add("difficulties", game->difficulties);
  reply.add("minimal", game->minimal_actions);
  reply.add("legal", game->legal_actions);
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

std::shared_ptr<const Image> sent_image(Context& context, const LoadWords& words) {
  if (!words.image) throw RequestError(ErrorCode::kBadArguments, "load inline needs image=BASE64");
  context.memory.check(words.image->size() / 4 * 3, "an image");
  auto bytes = bytes_of_base64(*words.image);
  if (!bytes)
    throw RequestError(ErrorCode::kBadImage, "the image is not base64 (A-Z a-z 0-9 + / and = at the end)");
  try {
    return make_image(std::move(*bytes), std::string(kInline));
  } catch (const InvalidInput& error) {
    throw RequestError(ErrorCode::kBadImage, error.what());
  }
}

Cartridge find_cartridge(Context& context, std::string_view name, const LoadWords& words) {
  Cartridge cartridge;
  if (name == kInline) {
    cartridge.image = sent_image(context, words);
  } else {
    if (words.image) throw RequestError(ErrorCode::kBadArguments, "image= requires load inline");
    const Cartridge* found = context.service.images->find(name);
    if (found == nullptr) refuse_game(*context.service.images, name);
    cartridge = *found;
  }
  if (words.as) {
    const auto rules = context.service.images->rules(*words.as);
    if (!rules)
      throw RequestError(ErrorCode::kUnknownGame, "unknown game " + quote(*words.as) + ';' +
                                                      did_you_mean(*words.as, game_names()) +
                                                      " games all lists all games");
    cartridge.game = recognise_as(*cartridge.image, rules).game;
  } else if (name == kInline) {
    cartridge.game = recognise(*cartridge.image).game;
  }
  if (const auto same_image = context.service.images->same(*cartridge.image)) cartridge.image = same_image;
  return cartridge;
}

// Explains why the machine is not in the requested mode: it begins in the default mode.
std::string with_wished_mode(std::string sentence, const PlaySettings& settings, const Cartridge& cartridge) {
  if (!settings.mode || !cartridge.game) return sentence;
  const std::string first = std::to_string(cartridge.game->default_mode);
  if (!sentence.starts_with("mode " + first + " of ") || *settings.mode == cartridge.game->default_mode)
    return sentence;
  return sentence + "; a machine begins in mode " + first + ", the default, before it takes mode " +
         std::to_string(*settings.mode);
}

void add_loaded(const Context& context, Reply& reply) {
  const Environment& machine = context.game.loaded->machine();
  reply.add("game", machine.game().name);
  reply.add("md5", machine.image().md5);
  reply.add("rule", machine.game().has_rule());
  if (is_other_dump(machine.game(), machine.image()))
    reply.add("image", "other");
  else if (is_doubtful(machine.game(), machine.image()))
    reply.add("image", "doubtful");
  reply.add("width", kScreenWidth);
  reply.add("height", machine.height());
  reply.add("format", name_of(machine.format()));
  reply.add_settings([&](std::string& out) { append_settings(out, context.game.settings, machine); });
}

}  // namespace

void run_games(Context& context, Words arguments, Reply& reply) {
  if (!arguments.empty() && arguments[0] != "all") return describe_game(context, arguments[0], reply);
  if (arguments.empty()) return add_names(reply, context.service.images->names());
  add_names(reply, game_names());
}

// All or nothing: a refused load leaves the previous game running.
void run_load(Context& context, Words arguments, Reply& reply) {
  const LoadWords words = sorted(arguments.subspan(1));
  PlaySettings settings;
  settings.machine.cpu = context.service.cpu;
  read_settings(words.settings, settings, kKeysOfImages);
  if (shows_audio(context.fields) && !settings.machine.sound)
    throw RequestError(ErrorCode::kBadArguments,
                       "observe selects audio, which needs sound=1; load with it, or observe other fields");
  if (settings.machine.random_seed == 0) settings.machine.random_seed = parse_seed("random");
  // The cache of resets belongs to the process, and would keep the image when the session is gone.
  Cartridge cartridge = find_cartridge(context, arguments[0], words);
  cartridge.game = with_overrides(cartridge.game, *cartridge.image, settings.console);
  std::unique_ptr<CodeOwner> own_image;
  if (context.service.images->same(*cartridge.image) == nullptr)
    own_image = std::make_unique<CodeOwner>(cartridge.image->bytes);
  settings.machine.copy_resets = own_image == nullptr;
  std::unique_ptr<LoadedMachine> loaded;
  try {
    context.allow_resets(1);
    context.memory.check(LoadedMachine::max_footprint(context.fields) + View::longest_text(context.fields),
                         "a machine");
    loaded = std::make_unique<LoadedMachine>(cartridge, settings, context.fields, context.pacer);
  } catch (const InvalidInput& error) {
    const bool sent = arguments[0] == kInline && !settings.mode && !settings.difficulty;
    throw RequestError(sent ? ErrorCode::kBadImage : ErrorCode::kBadValue,
                       with_wished_mode(error.what(), settings, cartridge));
  }
  context.memory.check(loaded->machine().cartridge_ram_size(), "the RAM of the cartridge");
  context.media.recording.reset();
  context.media.log.reset();
  context.machines.close();
  context.discard(context.game.states, context.game.states.footprint());
  context.game.loaded = std::move(loaded);
  context.game.cartridge = std::move(cartridge);
  context.game.own_image = std::move(own_image);
  context.game.settings = settings;
  context.game.episode = 1;
  context.game.last_action = 0;
  if (context.service.share_all && !context.sharing)
    context.sharing = Sharing::open_next(context.service.shares, kUsualWatchers);
  add_loaded(context, reply);
}

void run_settings(Context& context, Words, Reply& reply) { add_loaded(context, reply); }

void run_set(Context& context, Words arguments, Reply& reply) {
  PlaySettings changed;
  for (const std::string_view word : arguments) {
    const std::string_view key = key_value(word).key;
    if (std::ranges::find(kKeysOfSet, key) != kKeysOfSet.end()) continue;
    throw RequestError(ErrorCode::kBadArguments,
                       quote(key) + " cannot be set while a game runs;" +
                           advice(key, kKeysOfSet, "accepted: mode and difficulty; load takes the others"));
  }
  read_settings(arguments, changed);
  Environment& machine = context.game.loaded->machine();
  const int mode = machine.mode();
  if (changed.mode) machine.set_mode(*changed.mode);
  try {
    if (changed.difficulty) machine.set_difficulty(*changed.difficulty);
  } catch (...) {
    machine.set_mode(mode);
    throw;
  }
  context.drop_log("set changed it");
  if (changed.mode) context.game.settings.mode = changed.mode;
  if (changed.difficulty) context.game.settings.difficulty = changed.difficulty;
  reply.add("mode", machine.mode());
  reply.add("difficulty", machine.difficulty());
}

void run_modes(Context& context, Words, Reply& reply) {
  const Environment& machine = context.game.loaded->machine();
  reply.add("mode", machine.mode());
  reply.add("default", machine.game().default_mode);
  reply.add("modes", machine.game().modes);
  reply.add("two_player_modes", machine.game().two_player_modes);
}

void run_difficulties(Context& context, Words, Reply& reply) {
  const Environment& machine = context.game.loaded->machine();
  reply.add("difficulty", machine.difficulty());
  reply.add("default", 0);
  reply.add("difficulties", machine.game().difficulties);
}

void run_actions(Context& context, Words, Reply& reply) {
  const Game& game = context.game.loaded->machine().game();
  reply.add("action_set", name_of(context.game.settings.action_set));
  std::vector<std::string> actions;
  for (const int action : context.game.loaded->slot().actions())
    actions.push_back(std::to_string(action).append(1, ':').append(action_name(action)));
  reply.add_list("actions", actions);
  reply.add("minimal", game.minimal_actions);
  reply.add("legal", game.legal_actions);
}

void run_names(Context& context, Words, Reply& reply) {
  const Game& game = context.game.loaded->machine().game();
  std::vector<std::string> bytes;
  if (game.rule)
    for (const auto& [index, name] : game.rule->bytes) bytes.push_back(std::to_string(index) + ':' + name);
  reply.add_list("ram_names", bytes);
  reply.add_list("tia_names", kTiaValueNames);
}

}  // namespace racebeam
