// observe, look, act, reset, peek, poke
#include <algorithm>
#include <optional>

#include "protocol/line/session.hpp"

namespace racebeam {
namespace {

void check_sound(const Session& session, const std::vector<Field>& fields) {
  if (session.loaded && !session.settings.machine.sound && shows_audio(fields))
    throw RequestError(ErrorCode::kBadArguments, "audio needs a game that was loaded with sound=1");
}

// A single look has no past.
void check_look(const std::vector<Field>& fields) {
  for (const Field& field : fields) {
    if (field.encoding == Encoding::kDelta)
      throw RequestError(ErrorCode::kBadArguments,
                         "delta is for observe: it tells what changed from reply to reply");
    if (field.stack && field.stack->depth > 1)
      throw RequestError(ErrorCode::kBadArguments,
                         "a stack is for observe: it is made of what replies have shown");
  }
}

void append_bytes_of(Session& session, int index, std::size_t count) {
  session.out += "ok";
  append_pair(session.out, "index", index);
  append_pair(session.out, "bytes", "");
  Encoder(Encoding::kHex)
      .append(session.out, session.loaded->machine().ram().subspan(static_cast<std::size_t>(index), count),
              session.raw);
}

void play(Slot& slot, const std::vector<Action>& actions) {
  for (const Action& action : actions) {
    for (int n = 0; n < action.times; ++n) {
      slot.act(action.act);
      if (slot.finished()) return;
    }
  }
}

// The stack that one of the fields is, of one screen.
std::optional<ScreenStack> stack_of(const std::vector<Field>& fields, const Slot& slot) {
  std::optional<ScreenStack> stack;
  for (const Field& field : fields) {
    if (!field.stack) continue;
    stack.emplace(*field.stack, slot.environment());
    stack->look(slot.environment(), slot.blends());
    stack->push();
  }
  return stack;
}

int ram_index(std::string_view text) {
  return static_cast<int>(number_within(text, "INDEX", 0, kRamSize - 1));
}

}  // namespace

void run_observe(Session& session, Words arguments) {
  if (!arguments.empty()) {
    std::vector<Field> fields = parse_fields(arguments);
    check_sound(session, fields);
    session.memory.check(View::most_held(fields) + View::longest_text(fields), "a view of these fields");
    if (session.loaded) stack_of(fields, session.loaded->slot());  // it can be made
    session.machines.observe(fields);
    session.fields = std::move(fields);
    if (session.loaded) session.loaded->observe(session.fields);
  }
  session.out += "ok fields=";
  for (std::size_t i = 0; i < session.fields.size(); ++i) {
    if (i > 0) session.out += ',';
    session.out += session.fields[i].name;
  }
}

void run_look(Session& session, Words arguments) {
  LoadedMachine& loaded = *session.loaded;
  if (arguments.empty()) {
    session.out += "ok";
    return loaded.append_view(session.out, session.raw);
  }
  std::vector<Field> fields = parse_fields(arguments);
  check_sound(session, fields);
  check_look(fields);
  session.memory.check(View::most_held(fields) + text_size(fields, loaded.machine()),
                       "a look at these fields");
  const auto stack = stack_of(fields, loaded.slot());
  session.out += "ok";
  View(std::move(fields), [&session] {
    session.pacer.breathe();
  }).append(session.out, session.raw, {loaded.machine(), loaded.slot().outcome(), stack ? &*stack : nullptr});
}

void run_reset(Session& session, Words arguments) {
  LoadedMachine& loaded = *session.loaded;
  std::optional<std::uint32_t> seed;
  if (!arguments.empty()) seed = parse_seed(value_of(arguments[0], "seed", "reset"));
  session.allow_resets(1);
  loaded.slot().reset(seed);
  if (seed) session.settings.machine.random_seed = *seed;
  ++session.episode;
  loaded.slot().begin_request();
  session.out += "ok";
  loaded.append_view(session.out, session.raw);
}

// The next episode begins at once; the reply has the ends of the one before.
void begin_next_episode(Session& session) {
  Slot& slot = session.loaded->slot();
  session.loaded->append_final(session.out, session.raw);
  const Outcome outcome = slot.outcome();
  slot.reset();
  slot.set_outcome(outcome);
  ++session.episode;
}

// Assumes that a reset takes as long as the longest one so far.
std::int64_t frames_of_reset(const Slot& slot, Autoreset autoreset) {
  if (autoreset != Autoreset::kSameStep) return 0;
  return std::max<std::int64_t>(slot.reset_frames() - kFreeResetFrames, 0);
}

// Ends early with the episode.
void run_act(Session& session, Words arguments) {
  LoadedMachine& loaded = *session.loaded;
  std::vector<Action>& actions = session.actions;
  std::int64_t acts = 0;
  actions.clear();
  for (const std::string_view word : arguments) {
    actions.push_back(parse_action(word, loaded.allowed()));
    acts += actions.back().times;
    if (actions.size() % 256 == 0) session.pacer.breathe();
  }
  const Autoreset autoreset = session.settings.autoreset;
  session.check_frames(acts, frames_of_reset(loaded.slot(), autoreset));
  if (autoreset == Autoreset::kNextStep && loaded.slot().finished()) {
    run_reset(session, {});
    return session.append_cut();
  }
  // Only a restored state can have ended before.
  if (autoreset == Autoreset::kSameStep && loaded.slot().finished()) loaded.slot().reset();
  loaded.slot().begin_request();
  play(loaded.slot(), actions);
  if (loaded.slot().outcome().acts > 0) session.last_action = actions.back().act.a;
  session.count(loaded.slot().outcome());
  session.out += "ok";
  session.append_cut();
  if (autoreset == Autoreset::kSameStep && loaded.slot().finished()) begin_next_episode(session);
  loaded.append_view(session.out, session.raw);
}

void run_peek(Session& session, Words arguments) {
  const int index = ram_index(arguments[0]);
  const std::size_t count =
      arguments.size() < 2
          ? 1
          : static_cast<std::size_t>(number_within(arguments[1], "COUNT", 1, kRamSize - index));
  append_bytes_of(session, index, count);
}

void run_poke(Session& session, Words arguments) {
  const int index = ram_index(arguments[0]);
  const auto bytes = bytes_of_hex(arguments[1]);
  if (bytes.empty() || bytes.size() > static_cast<std::size_t>(kRamSize - index)) {
    throw RequestError(ErrorCode::kBadValue, "HEX has " + std::to_string(bytes.size()) + " bytes; from " +
                                                 std::to_string(index) + " on there is room for 1 to " +
                                                 std::to_string(kRamSize - index));
  }
  for (std::size_t i = 0; i < bytes.size(); ++i)
    session.loaded->machine().set_ram(index + static_cast<int>(i), bytes[i]);
  append_bytes_of(session, index, bytes.size());
}

}  // namespace racebeam
