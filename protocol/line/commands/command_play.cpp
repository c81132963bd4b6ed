// observe, look, act, reset, peek, poke
#include <algorithm>
#include <optional>

#include "protocol/line/context.hpp"
#include "protocol/line/reply.hpp"
#include "protocol/line/session_log.hpp"
#include "protocol/line/session_recording.hpp"

namespace racebeam {
namespace {

void check_sound(const Context& context, const std::vector<Field>& fields) {
  if (context.game.loaded && !context.game.settings.machine.sound && shows_audio(fields))
    throw RequestError(ErrorCode::kBadArguments, "audio needs a game that was loaded with sound=1");
}

// `look` has no earlier reply, so it accepts neither stacks nor delta.
void check_look(const std::vector<Field>& fields) {
  for (const Field& field : fields) {
    if (field.encoding == Encoding::kDelta)
      throw RequestError(ErrorCode::kBadArguments,
                         "delta is for observe: it tells what changed from reply to reply");
    if (shows_all_audio({field}))
      throw RequestError(ErrorCode::kBadArguments,
                         "audio_all is for observe: samples of every frame are made from then on");
    if (field.stack && field.stack->depth > 1)
      throw RequestError(ErrorCode::kBadArguments,
                         "a stack is for observe: it is made of what replies have shown");
  }
}

void add_bytes_of(const Context& context, int index, std::size_t count, Reply& reply) {
  reply.add("index", index);
  Encoder(Encoding::kHex)
      .append(reply.add_long("bytes"),
              context.game.loaded->machine().ram().subspan(static_cast<std::size_t>(index), count),
              reply.raw_memory());
}

// What the machine of `load` shows.
void add_view(LoadedMachine& loaded, Reply& reply) {
  reply.add_fields([&loaded](std::string& out, std::string& raw) { loaded.append_view(out, raw); });
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

void run_observe(Context& context, Words arguments, Reply& reply) {
  if (!arguments.empty()) {
    std::vector<Field> fields = parse_fields(arguments);
    check_sound(context, fields);
    context.memory.check(View::max_footprint(fields) + View::longest_text(fields), "a view of these fields");
    if (context.game.loaded) stack_of(fields, context.game.loaded->slot());  // it can be made
    context.machines.observe(fields);
    context.fields = std::move(fields);
    if (context.game.loaded) context.game.loaded->observe(context.fields);
  }
  std::vector<std::string_view> names;
  for (const Field& field : context.fields) names.push_back(field.name);
  reply.add_list("fields", names);
}

void run_look(Context& context, Words arguments, Reply& reply) {
  LoadedMachine& loaded = *context.game.loaded;
  if (arguments.empty()) return add_view(loaded, reply);
  std::vector<Field> fields = parse_fields(arguments);
  check_sound(context, fields);
  check_look(fields);
  context.memory.check(View::max_footprint(fields) + text_size(fields, loaded.machine()),
                       "a look at these fields");
  const auto stack = stack_of(fields, loaded.slot());
  View view(std::move(fields), [&context] { context.pacer.yield_if_due(); });
  reply.add_fields([&](std::string& out, std::string& raw) {
    view.append(out, raw, {loaded.machine(), loaded.slot().outcome(), stack ? &*stack : nullptr});
  });
}

// A log begins each episode with a new seed, which `settings` then shows.
void begin_episode(Context& context, std::optional<std::uint32_t> seed = {}) {
  LoadedMachine& loaded = *context.game.loaded;
  loaded.slot().reset(seed);
  context.game.settings.machine.random_seed = loaded.machine().settings().random_seed;
  ++context.game.episode;
}

void run_reset(Context& context, Words arguments, Reply& reply) {
  LoadedMachine& loaded = *context.game.loaded;
  std::optional<std::uint32_t> seed;
  if (!arguments.empty()) seed = parse_seed(value_of(arguments[0], "seed", "reset"));
  context.allow_resets(1);
  begin_episode(context, seed);
  loaded.slot().begin_request();
  add_view(loaded, reply);
}

// The next episode begins at once; the reply has the ends of the one before.
void begin_next_episode(Context& context, Reply& reply) {
  Slot& slot = context.game.loaded->slot();
  reply.add_fields(
      [&context](std::string& out, std::string& raw) { context.game.loaded->append_final(out, raw); });
  const Outcome outcome = slot.outcome();
  begin_episode(context);
  slot.set_outcome(outcome);
}

// Assumes that a reset takes as long as the longest one so far.
std::int64_t frames_of_reset(const Slot& slot, Autoreset autoreset) {
  if (autoreset != Autoreset::kSameStep) return 0;
  return std::max<std::int64_t>(slot.reset_frames() - kFreeResetFrames, 0);
}

// Ends early with the episode.
void run_act(Context& context, Words arguments, Reply& reply) {
  LoadedMachine& loaded = *context.game.loaded;
  std::vector<Action>& actions = context.scratch.actions;
  std::int64_t acts = 0;
  actions.clear();
  for (const std::string_view word : arguments) {
    actions.push_back(parse_action(word, loaded.allowed()));
    acts += actions.back().times;
    if (actions.size() % 256 == 0) context.pacer.yield_if_due();
  }
  const Autoreset autoreset = context.game.settings.autoreset;
  context.check_frames(acts, frames_of_reset(loaded.slot(), autoreset));
  if (shows_all_audio(context.fields)) context.check_audio(acts);
  if (autoreset == Autoreset::kNextStep && loaded.slot().finished()) {
    run_reset(context, {}, reply);
    add_cut(context, reply);
    return add_log_cut(context, reply);
  }
  // Only a restored state can have ended before.
  if (autoreset == Autoreset::kSameStep && loaded.slot().finished()) begin_episode(context);
  loaded.slot().begin_request();
  play(loaded.slot(), actions);
  if (loaded.slot().outcome().acts > 0) context.game.last_action = actions.back().act.a;
  context.count(loaded.slot().outcome());
  add_cut(context, reply);
  add_log_cut(context, reply);
  if (autoreset == Autoreset::kSameStep && loaded.slot().finished()) begin_next_episode(context, reply);
  add_view(loaded, reply);
}

void run_peek(Context& context, Words arguments, Reply& reply) {
  const int index = ram_index(arguments[0]);
  const std::size_t count =
      arguments.size() < 2
          ? 1
          : static_cast<std::size_t>(number_within(arguments[1], "COUNT", 1, kRamSize - index));
  add_bytes_of(context, index, count, reply);
}

void run_poke(Context& context, Words arguments, Reply& reply) {
  const int index = ram_index(arguments[0]);
  const auto bytes = bytes_of_hex(arguments[1]);
  if (bytes.empty() || bytes.size() > static_cast<std::size_t>(kRamSize - index)) {
    throw RequestError(ErrorCode::kBadValue, "HEX has " + std::to_string(bytes.size()) +
                                                 " bytes; from address " + std::to_string(index) +
                                                 " on, RAM takes at least 1, and at most " +
                                                 std::to_string(kRamSize - index));
  }
  context.drop_log("poke wrote RAM in it");
  for (std::size_t i = 0; i < bytes.size(); ++i)
    context.game.loaded->machine().set_ram(index + static_cast<int>(i), bytes[i]);
  add_bytes_of(context, index, bytes.size(), reply);
}

}  // namespace racebeam
