// save, restore, drop, states, export, import, branch
#include <algorithm>
#include <optional>
#include <utility>

#include "environment/saved/saved_state_format.hpp"
#include "environment/saved_state.hpp"
#include "environment/vector/saved_slot_format.hpp"
#include "games/similar.hpp"
#include "protocol/encoding/base64.hpp"
#include "protocol/line/commands/branch.hpp"
#include "protocol/line/session.hpp"
#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

constexpr std::size_t kBetweenLooks = 256;  // names, or actions, between two looks at the clock

const Slot::Saved& find_state(const Session& session, std::string_view name) {
  if (const Slot::Saved* const found = session.states.find(name)) return *found;
  std::vector<std::string_view> names;
  for (const auto& [known, place] : session.states) names.push_back(known);
  std::string sentence = "there is no state " + quote(name) + ';';
  if (const std::string meant = did_you_mean(name, names); !meant.empty()) {
    (sentence += meant) += " There are";
  } else {
    sentence += " there are";
  }
  constexpr std::size_t kShown = 20;
  for (const std::string_view known : Words(names).first(std::min(kShown, names.size())))
    (sentence += ' ') += known;
  throw RequestError(ErrorCode::kNoState, sentence + (session.states.empty()  ? " none"
                                                      : names.size() > kShown ? " and more"
                                                                              : ""));
}

void check_room(const Session& session, std::size_t more) {
  const auto most = static_cast<std::size_t>(session.service.limits.states);
  if (session.states.size() + more <= most) return;
  throw RequestError(ErrorCode::kLimit, "there is room for " + std::to_string(most) +
                                            " states; drop some, or save under a name that is in use");
}

void keep(Session& session, std::string_view name, Slot::Saved place) {
  if (!session.states.contains(name)) check_room(session, 1);
  session.memory.check(place.footprint(), "a state");
  session.states.put(name, std::move(place));
}

std::string_view state_name(std::string_view word) {
  if (word == "all")
    throw RequestError(ErrorCode::kBadValue, "'all' is no name for a state: drop all drops them all");
  return checked_name(word, "state");
}

// The names under which `lists` ends of a branch are kept; all of them are good, and there is room for the
// new ones.
void check_keep(const Session& session, std::string_view prefix, std::size_t lists) {
  std::size_t added = 0;
  for (std::size_t list = 0; list < lists; ++list) {
    const std::string name = std::string(prefix) + std::to_string(list);
    state_name(name);
    added += !session.states.contains(name);
    check_room(session, added);
  }
}

bool flag_of(std::string_view word, std::string_view key, std::string_view command) {
  return number_within(value_of(word, key, command), key, 0, 1) == 1;
}

struct SaveOptions {
  bool generator = false;
  std::optional<std::size_t> machine;  // of `open`
};

SaveOptions read_save_options(const Session& session, Words words) {
  SaveOptions options;
  std::string_view before;
  for (const std::string_view word : words) {
    std::string_view key = word;
    const std::string_view value = cut_behind(key, '=');
    if (key == std::exchange(before, key)) refuse_twice(key);
    if (key == "machine") {
      options.machine = session.machines.number_of(value);
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
std::int64_t add_list(ActionLists& lists, std::string_view word, Session& session) {
  std::int64_t acts = 0;
  for (bool last = false; !last;) {
    std::string_view action = word;
    const std::string_view rest = cut_behind(action, ',');
    last = action.size() == word.size();
    word = rest;
    lists.actions.push_back(parse_action(action, session.loaded->allowed()));
    acts += lists.actions.back().times;
    if (lists.actions.size() % kBetweenLooks == 0) session.pacer.breathe();
  }
  lists.ends.push_back(lists.actions.size());
  return acts;
}

// One of `open`. A stack that would begin anew is refused, since an agent would not notice.
void restore_machine(Session& session, const Slot::Saved& place, std::string_view text) {
  const std::size_t number = session.machines.number_of(text);
  Slot& slot = session.machines.slot(number);
  try {
    slot.check_stack(place);
  } catch (const InvalidInput& error) {
    throw RequestError(ErrorCode::kBadState, error.what());
  }
  slot.restore(place);
  slot.begin_request();
  session.out += "ok";
  session.machines.append_view(number);
}

// A whole state, or that of a console alone.
Slot::Saved imported(std::span<const std::uint8_t> bytes, const Environment& machine) {
  try {
    if (is_saved_slot(bytes)) return saved_slot(bytes, machine);
    Slot::Saved place;
    place.machine = from_bytes(bytes, machine);
    place.with_random = place.machine->random.has_value();
    return place;
  } catch (const InvalidInput& error) {
    throw RequestError(ErrorCode::kBadState, error.what());
  }
}

// What lists of so many characters take, at most: a character and a comma are an action, and a vector that
// grows has a copy for a moment.
void check_memory(Session& session, Words lists) {
  std::size_t actions = 0;
  for (const std::string_view list : lists) actions += list.size() / 2 + 1;
  session.memory.check(3 * (sizeof(Action) * actions + sizeof(std::size_t) * lists.size()),
                       "lists of actions");
}

}  // namespace

void run_save(Session& session, Words arguments) {
  const std::string_view name = state_name(arguments[0]);
  const SaveOptions options = read_save_options(session, arguments.subspan(1));
  const bool generator = options.generator;
  keep(session, name,
       options.machine ? session.machines.slot(*options.machine).save(generator, generator)
                       : session.loaded->slot().save(generator));
  session.out += "ok";
  append_pair(session.out, "state", name);
}

// The settings of machines that `open` makes later: the mode and the difficulty may be those of the state.
void follow(Session& session, const Environment& machine) {
  PlaySettings& settings = session.settings;
  if (machine.mode() != settings.mode.value_or(machine.game().default_mode)) settings.mode = machine.mode();
  if (machine.difficulty() != settings.difficulty.value_or(0)) settings.difficulty = machine.difficulty();
}

void run_restore(Session& session, Words arguments) {
  const Slot::Saved& place = find_state(session, arguments[0]);
  if (arguments.size() == 2)
    return restore_machine(session, place, value_of(arguments[1], "machine", "restore"));
  session.loaded->slot().restore(place);
  session.loaded->slot().begin_request();
  follow(session, session.loaded->machine());
  session.out += "ok";
  session.loaded->append_view(session.out, session.raw);
}

void run_drop(Session& session, Words arguments) {
  if (arguments.size() == 1 && arguments[0] == "all") {
    session.discard(session.states, session.states.footprint());
  } else {
    std::size_t looked = 0;
    for (const std::string_view name : arguments) {
      find_state(session, name);
      if (++looked % kBetweenLooks == 0) session.pacer.breathe();
    }
    for (const std::string_view name : arguments) {
      session.states.drop(name);
      if (--looked % kBetweenLooks == 0) session.pacer.breathe();
    }
  }
  session.out += "ok";
  append_pair(session.out, "count", static_cast<std::int64_t>(session.states.size()));
}

void run_states(Session& session, Words) {
  session.out += "ok";
  append_pair(session.out, "count", static_cast<std::int64_t>(session.states.size()));
  append_pair(session.out, "states", "");
  bool first = true;
  for (const auto& [name, place] : session.states) {
    if (!std::exchange(first, false)) session.out += ',';
    session.out += name;
  }
}

void run_export(Session& session, Words arguments) {
  const Slot::Saved& place = find_state(session, arguments[0]);
  const bool whole = arguments.size() == 2 && flag_of(arguments[1], "episode", "export");
  const std::size_t reply = 2 * place.footprint();
  session.check_reply(reply, "this state");
  session.memory.check(3 * reply, "a reply about this state");
  const Environment& artist = session.loaded->machine();
  const auto bytes = whole ? to_bytes(place, artist) : to_bytes(*place.machine, artist);
  session.out += "ok";
  append_pair(session.out, "state", arguments[0]);
  append_pair(session.out, "bytes", static_cast<std::int64_t>(bytes.size()));
  append_pair(session.out, "data", "");
  append_base64(session.out, bytes);
}

void run_import(Session& session, Words arguments) {
  const std::string_view name = state_name(arguments[0]);
  const auto bytes = bytes_of_base64(arguments[1]);
  if (!bytes)
    throw RequestError(ErrorCode::kBadState, "the state is not base64 (A-Z a-z 0-9 + / and = at the end)");
  keep(session, name, imported(*bytes, session.loaded->machine()));
  session.out += "ok";
  append_pair(session.out, "state", name);
}

// The reply, and the rewards that are collected before, grow by doubling: there is a copy for a moment.
constexpr std::size_t kRewardsOfAct = 48;

void run_branch(Session& session, Words arguments) {
  BranchRequest branch{find_state(session, arguments[0]), {}, {}};
  Words sequences = arguments.subspan(1);
  if (sequences[0].starts_with("keep=")) {
    branch.keep = checked_name(key_value(sequences[0]).value, "state");
    sequences = sequences.subspan(1);
  }
  if (sequences.empty())
    throw RequestError(ErrorCode::kBadArguments, "branch takes at least one list of actions");
  std::int64_t acts = 0;
  check_memory(session, sequences);
  for (const std::string_view word : sequences) {
    acts += add_list(branch.lists, word, session);
    session.pacer.breathe();
  }
  session.check_frames(acts);
  const std::size_t lists = branch.lists.size();
  const std::size_t players = session.loaded->machine().game().has_second_reward() ? 2 : 1;
  const std::size_t reply = 128 * lists + 8 * players * static_cast<std::size_t>(acts);
  session.check_reply(reply, std::to_string(lists) + " branches");
  session.memory.check(3 * reply + kRewardsOfAct * players * static_cast<std::size_t>(acts),
                       "a reply about " + std::to_string(lists) + " branches");
  if (!branch.keep.empty()) check_keep(session, branch.keep, lists);
  play_branches(session, branch);
}

}  // namespace racebeam
