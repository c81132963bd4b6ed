// save, restore, drop, states, export, import, branch
#include <algorithm>
#include <optional>
#include <utility>

#include "environment/saved/saved_state_format.hpp"
#include "environment/saved_state.hpp"
#include "environment/vector/saved_slot_format.hpp"
#include "protocol/encoding/base64.hpp"
#include "protocol/line/commands/branch.hpp"
#include "protocol/line/context.hpp"
#include "protocol/line/reply.hpp"
#include "protocol/request_error.hpp"
#include "system/invalid_input.hpp"
#include "system/similar.hpp"

namespace racebeam {
namespace {

constexpr std::size_t kBetweenLooks = 256;  // names, or actions, between two looks at the clock

const Slot::Saved& find_state(const Context& context, std::string_view name) {
  if (const Slot::Saved* const found = context.game.states.find(name)) return *found;
  std::vector<std::string_view> names;
  for (const auto& [key, place] : context.game.states) names.push_back(key);
  std::string sentence = "unknown state " + quote(name) + ';';
  if (const std::string similar = did_you_mean(name, names); !similar.empty()) {
    (sentence += similar) += " Accepted:";
  } else {
    sentence += " accepted:";
  }
  constexpr std::size_t kShown = 20;
  for (const std::string_view key : Words(names).first(std::min(kShown, names.size())))
    (sentence += ' ') += key;
  throw RequestError(ErrorCode::kNoState, sentence + (context.game.states.empty() ? " none"
                                                      : names.size() > kShown     ? " and more"
                                                                                  : ""));
}

void check_room(const Context& context, std::size_t more) {
  const auto most = static_cast<std::size_t>(context.service.limits.states);
  if (context.game.states.size() + more <= most) return;
  throw RequestError(ErrorCode::kLimit, "there is room for " + std::to_string(most) +
                                            " states; drop some, or save under a name that is in use");
}

void keep(Context& context, std::string_view name, Slot::Saved place) {
  if (!context.game.states.contains(name)) check_room(context, 1);
  context.memory.check(place.footprint(), "a state");
  context.game.states.put(name, std::move(place));
}

std::string_view state_name(std::string_view word) {
  if (word == "all")
    throw RequestError(ErrorCode::kBadValue,
                       "a state cannot be named 'all', because drop all deletes all states");
  return checked_name(word, "state");
}

// The names under which `lists` ends of a branch are kept; all of them are good, and there is room for the
// new ones.
void check_keep(const Context& context, std::string_view prefix, std::size_t lists) {
  std::size_t added = 0;
  for (std::size_t list = 0; list < lists; ++list) {
    const std::string name = std::string(prefix) + std::to_string(list);
    state_name(name);
    added += !context.game.states.contains(name);
    check_room(context, added);
  }
}

bool flag_of(std::string_view word, std::string_view key, std::string_view command) {
  return number_within(value_of(word, key, command), key, 0, 1) == 1;
}

struct SaveOptions {
  bool generator = false;
  std::optional<std::size_t> machine;  // of `open`
};

SaveOptions read_save_options(const Context& context, Words words) {
  SaveOptions options;
  std::string_view before;
  for (const std::string_view word : words) {
    std::string_view key = word;
    const std::string_view value = cut_behind(key, '=');
    if (key == std::exchange(before, key)) refuse_twice(key);
    if (key == "machine") {
      options.machine = context.machines.number_of(value);
    } else if (key == "generator") {
      options.generator = number_within(value, key, 0, 1) == 1;
    } else {
      throw RequestError(ErrorCode::kBadArguments,
                         quote(word) + " is not accepted here; save takes generator= and machine=");
    }
  }
  return options;
}

// Adds the list A,B,C. Returns how many acts it has.
std::int64_t add_list(ActionLists& lists, std::string_view word, Context& context) {
  std::int64_t acts = 0;
  for (bool last = false; !last;) {
    std::string_view action = word;
    const std::string_view rest = cut_behind(action, ',');
    last = action.size() == word.size();
    word = rest;
    lists.actions.push_back(parse_action(action, context.game.loaded->allowed()));
    acts += lists.actions.back().times;
    if (lists.actions.size() % kBetweenLooks == 0) context.pacer.yield_if_due();
  }
  lists.ends.push_back(lists.actions.size());
  return acts;
}

// One of `open`. A stack that would begin anew is refused, since an agent would not notice.
void restore_machine(Context& context, const Slot::Saved& place, std::string_view text, Reply& reply) {
  const std::size_t number = context.machines.number_of(text);
  Slot& slot = context.machines.slot(number);
  try {
    slot.check_stack(place);
  } catch (const InvalidInput& error) {
    throw RequestError(ErrorCode::kBadState, error.what());
  }
  slot.restore(place);
  slot.begin_request();
  context.machines.add_view(number, reply);
}

// A whole state, or only that of a console.
Slot::Saved imported(std::span<const std::uint8_t> bytes, const Environment& machine) {
  try {
    if (is_saved_slot(bytes)) return saved_slot(bytes, machine);
    Slot::Saved place;
    place.machine = from_bytes(bytes, machine);
    place.with_random = place.machine->random != nullptr;
    return place;
  } catch (const InvalidInput& error) {
    throw RequestError(ErrorCode::kBadState, error.what());
  }
}

// The most memory that lists with these characters take: a character and a comma are an action, and a vector
// that grows has a copy for a moment.
void check_memory(Context& context, Words lists) {
  std::size_t actions = 0;
  for (const std::string_view list : lists) actions += list.size() / 2 + 1;
  context.memory.check(3 * (sizeof(Action) * actions + sizeof(std::size_t) * lists.size()),
                       "lists of actions");
}

}  // namespace

void run_save(Context& context, Words arguments, Reply& reply) {
  const std::string_view name = state_name(arguments[0]);
  const SaveOptions options = read_save_options(context, arguments.subspan(1));
  const bool generator = options.generator;
  keep(context, name,
       options.machine ? context.machines.slot(*options.machine).save(generator, generator)
                       : context.game.loaded->slot().save(generator));
  reply.add("state", name);
}

// The settings of machines that `open` makes later: the mode and the difficulty may be those of the state.
void follow(Context& context, const Environment& machine) {
  PlaySettings& settings = context.game.settings;
  if (machine.mode() != settings.mode.value_or(machine.game().default_mode)) settings.mode = machine.mode();
  if (machine.difficulty() != settings.difficulty.value_or(0)) settings.difficulty = machine.difficulty();
}

void run_restore(Context& context, Words arguments, Reply& reply) {
  const Slot::Saved& place = find_state(context, arguments[0]);
  if (arguments.size() == 2)
    return restore_machine(context, place, value_of(arguments[1], "machine", "restore"), reply);
  context.game.loaded->slot().restore(place);
  context.game.loaded->slot().begin_request();
  follow(context, context.game.loaded->machine());
  reply.add_fields(
      [&context](std::string& out, std::string& raw) { context.game.loaded->append_view(out, raw); });
}

void run_drop(Context& context, Words arguments, Reply& reply) {
  if (arguments.size() == 1 && arguments[0] == "all") {
    context.discard(context.game.states, context.game.states.footprint());
  } else {
    std::size_t looked = 0;
    for (const std::string_view name : arguments) {
      find_state(context, name);
      if (++looked % kBetweenLooks == 0) context.pacer.yield_if_due();
    }
    for (const std::string_view name : arguments) {
      context.game.states.drop(name);
      if (--looked % kBetweenLooks == 0) context.pacer.yield_if_due();
    }
  }
  reply.add("count", static_cast<std::int64_t>(context.game.states.size()));
}

void run_states(Context& context, Words, Reply& reply) {
  reply.add("count", static_cast<std::int64_t>(context.game.states.size()));
  std::vector<std::string_view> names;
  for (const auto& [name, place] : context.game.states) names.push_back(name);
  reply.add_list("states", names);
}

void run_export(Context& context, Words arguments, Reply& reply) {
  const Slot::Saved& place = find_state(context, arguments[0]);
  const bool whole = arguments.size() == 2 && flag_of(arguments[1], "episode", "export");
  const std::size_t longest = 2 * place.footprint();
  context.check_reply(longest, "this state");
  context.memory.check(3 * longest, "a reply about this state");
  const Environment& artist = context.game.loaded->machine();
  const auto bytes = whole ? to_bytes(place, artist) : to_bytes(*place.machine, artist);
  reply.add("state", arguments[0]);
  reply.add("bytes", static_cast<std::int64_t>(bytes.size()));
  append_base64(reply.add_long("data"), bytes);
}

void run_import(Context& context, Words arguments, Reply& reply) {
  const std::string_view name = state_name(arguments[0]);
  const auto bytes = bytes_of_base64(arguments[1]);
  if (!bytes)
    throw RequestError(ErrorCode::kBadState, "the state is not base64 (A-Z a-z 0-9 + / and = at the end)");
  keep(context, name, imported(*bytes, context.game.loaded->machine()));
  reply.add("state", name);
}

// The reply, and the rewards that are collected before, grow by doubling: there is a copy for a moment.
constexpr std::size_t kRewardsOfAct = 48;

void run_branch(Context& context, Words arguments, Reply& reply) {
  BranchRequest branch{find_state(context, arguments[0]), {}, {}};
  Words sequences = arguments.subspan(1);
  if (sequences[0].starts_with("keep=")) {
    branch.keep = checked_name(key_value(sequences[0]).value, "state");
    sequences = sequences.subspan(1);
  }
  if (sequences.empty())
    throw RequestError(ErrorCode::kBadArguments, "branch takes at least one list of actions");
  std::int64_t acts = 0;
  check_memory(context, sequences);
  for (const std::string_view word : sequences) {
    acts += add_list(branch.lists, word, context);
    context.pacer.yield_if_due();
  }
  context.check_frames(acts);
  const std::size_t lists = branch.lists.size();
  const std::size_t players = context.game.loaded->machine().game().has_second_reward() ? 2 : 1;
  const std::size_t longest = 128 * lists + 8 * players * static_cast<std::size_t>(acts);
  context.check_reply(longest, std::to_string(lists) + " branches");
  context.memory.check(3 * longest + kRewardsOfAct * players * static_cast<std::size_t>(acts),
                       "a reply about " + std::to_string(lists) + " branches");
  if (!branch.keep.empty()) check_keep(context, branch.keep, lists);
  play_branches(context, branch, reply);
}

}  // namespace racebeam
