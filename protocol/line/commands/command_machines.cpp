// open, step, restart, close
#include <algorithm>
#include <array>
#include <limits>

#include "environment/settings/play_settings.hpp"
#include "protocol/line/context.hpp"
#include "protocol/line/reply.hpp"
#include "system/named_rows.hpp"

namespace racebeam {
namespace {

struct OpenSettings {
  SlotSettings slot;
  Autoreset autoreset = Autoreset::kNextStep;
};

struct OpenRow {
  std::string_view name;
  bool of_frames;  // goes with steps=frames
  void (*read)(OpenSettings& settings, std::string_view value);
};

struct Start {
  ResetOrder order;
  bool fire;
};

constexpr std::array<WordFor<Steps>, 2> kSteps = {{{"frames", Steps::kFrames}, {"acts", Steps::kActs}}};
constexpr std::array<WordFor<Start>, 4> kStarts = {{{"fire-noops", {ResetOrder::kFireNoops, true}},
                                                    {"noops-fire", {ResetOrder::kNoopsFire, true}},
                                                    {"baselines", {ResetOrder::kBaselines, true}},
                                                    {"noops", {ResetOrder::kFireNoops, false}}}};
constexpr std::array<WordFor<StackStart>, 2> kStackStarts = {
    {{"zeros", StackStart::kZeros}, {"repeats", StackStart::kRepeats}}};
constexpr std::array<WordFor<bool>, 2> kFlags = {{{"0", false}, {"1", true}}};

const std::vector<OpenRow>& open_rows() {
  static const std::vector<OpenRow> rows = {
      {"autoreset", false,
       [](OpenSettings& s, std::string_view value) { s.autoreset = autoreset_of(value); }},
      {"life_loss", false,
       [](OpenSettings& s, std::string_view value) {
         s.slot.life_loss = life_loss_of(value);
         s.slot.machine.truncate_on_life_loss = false;
       }},
      {"steps", false,
       [](OpenSettings& s, std::string_view value) { s.slot.steps = value_for(value, "steps", kSteps); }},
      {"start", true,
       [](OpenSettings& s, std::string_view value) {
         const Start start = value_for(value, "start", kStarts);
         s.slot.reset_order = start.order;
         s.slot.fire_at_reset = start.fire;
       }},
      {"stack", true,
       [](OpenSettings& s, std::string_view value) {
         s.slot.stack_start = value_for(value, "stack", kStackStarts);
       }},
      {"pool", true,
       [](OpenSettings& s, std::string_view value) { s.slot.max_pool = value_for(value, "pool", kFlags); }},
  };
  return rows;
}

[[noreturn]] void refuse_word(std::string_view word) {
  std::string keys;
  for (const OpenRow& row : open_rows()) ((keys += keys.empty() ? "" : " ") += row.name) += '=';
  throw RequestError(ErrorCode::kBadArguments, "unknown setting " + quote(word) + "; accepted: " + keys);
}

OpenSettings read_open_settings(const Context& context, Words words) {
  OpenSettings settings{slot_settings(context.game.settings)};
  std::vector<std::string_view> keys;
  std::string_view of_frames;
  for (const std::string_view word : words) {
    if (word.find('=') == std::string_view::npos) refuse_word(word);
    const auto [key, value] = key_value(word);
    const auto row = std::ranges::find(open_rows(), key, &OpenRow::name);
    if (row == open_rows().end()) refuse_name("setting", key, names_of(open_rows()));
    if (std::ranges::find(keys, key) != keys.end()) refuse_twice(key);
    keys.push_back(key);
    if (row->of_frames) of_frames = key;
    row->read(settings, value);
  }
  if (settings.slot.steps == Steps::kActs && !of_frames.empty())
    throw RequestError(ErrorCode::kBadArguments, std::string(of_frames) + "= requires steps=frames");
  if (std::ranges::find(keys, "start") == keys.end())
    settings.slot.fire_at_reset = settings.slot.steps == Steps::kFrames;
  return settings;
}

std::size_t read_machines(const Context& context, std::string_view word) {
  const int most = context.service.limits.machines;
  if (const auto count = parse_number<std::int64_t>(word); count && *count > most)
    throw RequestError(ErrorCode::kLimit, "N is " + std::to_string(*count) + "; the limit is " +
                                              std::to_string(most) + " machines");
  return static_cast<std::size_t>(number_within(word, "N", 1, most));
}

[[noreturn]] void refuse_count(const Context& context, std::size_t count, const std::string& what) {
  throw RequestError(ErrorCode::kBadArguments, "there are " + std::to_string(context.machines.size()) +
                                                   " machines, but " + std::to_string(count) + " " + what);
}

std::vector<std::uint8_t> read_mask(const Context& context, std::string_view mask) {
  if (mask.find_first_not_of("01") != std::string_view::npos)
    throw RequestError(ErrorCode::kBadValue,
                       quote(mask) + " is not a mask; it takes a 0 or a 1 for each machine");
  if (mask.size() != context.machines.size())
    refuse_count(context, mask.size(), mask.size() == 1 ? "digit in the mask" : "digits in the mask");
  std::vector<std::uint8_t> bytes;
  for (const char digit : mask) bytes.push_back(digit == '1');
  return bytes;
}

}  // namespace

void run_open(Context& context, Words arguments, Reply& reply) {
  const std::size_t machines = read_machines(context, arguments[0]);
  const OpenSettings settings = read_open_settings(context, arguments.subspan(1));
  context.machines.open(machines, settings.slot, settings.autoreset, reply);
}

void run_step(Context& context, Words arguments, Reply& reply) {
  const AllowedActions allowed = context.game.loaded->allowed();
  const std::size_t machines = context.machines.size();
  if (arguments.size() != 1 && arguments.size() != machines)
    refuse_count(context, arguments.size(), "actions; give one each, or one for all");
  auto& acts = context.scratch.acts;
  acts.clear();
  for (const std::string_view word : arguments) {
    const Action action = parse_action(word, allowed);
    if (action.times > 1)
      throw RequestError(ErrorCode::kBadValue, "a step is one act; *TIMES is for act and branch");
    acts.push_back(action.act);
  }
  acts.resize(machines, acts[0]);
  context.machines.step(acts, reply);
}

void run_restart(Context& context, Words arguments, Reply& reply) {
  std::vector<std::uint8_t> mask;
  std::vector<std::int64_t> seeds;
  for (const std::string_view word : arguments) {
    if (word.find('=') == std::string_view::npos) {
      if (!mask.empty()) refuse_twice("MASK");
      mask = read_mask(context, word);
      continue;
    }
    if (!seeds.empty()) refuse_twice("seed");
    seeds.resize(context.machines.size());
    const std::uint32_t first = parse_seed(value_of(word, "seed", "restart"));
    for (std::size_t i = 0; i < seeds.size(); ++i) seeds[i] = first + static_cast<std::uint32_t>(i);
  }
  mask.resize(context.machines.size(), 1);
  context.machines.restart(mask, seeds, reply);
}

void run_close(Context& context, Words, Reply&) {
  context.stop_recording_machines();
  context.machines.close();
}

}  // namespace racebeam
