// log
#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>

#include "protocol/encoding/base64.hpp"
#include "protocol/encoding/encoding.hpp"
#include "protocol/line/context.hpp"
#include "protocol/line/reply.hpp"
#include "protocol/line/session_log.hpp"
#include "protocol/request_error.hpp"
#include "recording/phrase_seed.hpp"
#include "recording/recorder.hpp"
#include "recording/result_row.hpp"
#include "recording/sha256.hpp"
#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

constexpr std::string_view kInMemory = "inline";
constexpr std::size_t kMaxLink = 1000;
constexpr std::int64_t kMaxTrial = 1'000'000;

// The words of `log` after the name.
struct LogWords {
  std::optional<std::size_t> machine;  // of `open`
  EpisodeOrigin origin;
  AboutAgent about;
};

std::string checked_text(std::string_view text, std::string_view what) {
  if (!is_plain_name(text, kMaxAgentName))
    throw InvalidInput(std::string(what) + " is " + quote(text) + "; it takes " +
                       plain_name_rule(kMaxAgentName));
  return std::string(text);
}

std::string checked_link(std::string_view text) {
  const std::size_t scheme = text.starts_with("https://") ? 8 : text.starts_with("http://") ? 7 : text.size();
  if (scheme >= text.size() || text.size() > kMaxLink || text.find_first_of("\"\\") != text.npos)
    throw InvalidInput("link is " + quote(text) + "; it takes https://... or http://... and at most " +
                       std::to_string(kMaxLink) + " characters");
  return std::string(text);
}

std::string checked_phrase(std::string_view text) {
  std::string phrase(text);
  std::ranges::replace(phrase, '_', ' ');
  check_phrase(phrase);
  return phrase;
}

int count_of(std::string_view text, std::string_view what, std::int64_t most) {
  return static_cast<int>(number_within(text, what, 1, most));
}

struct LogOption {
  std::string_view name;
  void (*read)(LogWords& words, std::string_view value);  // null: machine=
};

constexpr std::array<LogOption, 9> kOptions = {{
    {"agent",
     [](LogWords& words, std::string_view value) { words.about.agent = checked_text(value, "agent"); }},
    {"version",
     [](LogWords& words, std::string_view value) { words.about.version = checked_text(value, "version"); }},
    {"agent_seed",
     [](LogWords& words, std::string_view value) {
       constexpr std::int64_t kMax = std::numeric_limits<std::uint32_t>::max();
       words.origin.agent_seed = static_cast<std::uint32_t>(number_within(value, "agent_seed", 0, kMax));
     }},
    {"trial", [](LogWords& words,
                 std::string_view value) { words.origin.trial = count_of(value, "trial", kMaxTrial); }},
    {"training_frames",
     [](LogWords& words, std::string_view value) {
       words.about.training_frames = number_within(value, "training_frames", 0, kMaxTrainingFrames);
     }},
    {"phrase", [](LogWords& words, std::string_view value) { words.about.phrase = checked_phrase(value); }},
    {"role",
     [](LogWords& words, std::string_view value) {
       words.about.role = kAgentRoles[choice_of(value, "role", kAgentRoles)];
     }},
    {"link", [](LogWords& words, std::string_view value) { words.about.link = checked_link(value); }},
    {"machine", nullptr},
}};

LogWords read_log_words(const Context& context, Words arguments) {
  LogWords words;
  std::vector<std::string_view> keys;
  for (const std::string_view word : arguments) {
    const auto [key, value] = key_value(word);
    const auto option = std::ranges::find(kOptions, key, &LogOption::name);
    if (option == kOptions.end()) refuse_name("setting", key, names_of(kOptions));
    if (std::ranges::find(keys, key) != keys.end()) refuse_twice(key);
    keys.push_back(key);
    option->read != nullptr ? option->read(words, value)
                            : void(words.machine = context.machines.number_of(value));
  }
  return words;
}

[[noreturn]] void refuse_log(const std::string& sentence) { throw RequestError(ErrorCode::kNoLog, sentence); }

// Refuses a game whose logs nobody could replay.
void check_game(const Context& context, const Slot& slot) {
  const Environment& machine = slot.environment();
  const std::string& name = machine.game().name;
  if (!find_game(name) && context.service.images->find(name) == nullptr)
    refuse_log("the game " + name + " is not in the catalogue; nobody could play its episodes again");
  if (!context.game.settings.console.empty())
    refuse_log(
        "an episode is played again with the properties of its image; load without scheme, left, right, "
        "format, ystart and height");
  if (slot.settings().steps == Steps::kFrames) refuse_log("a log has acts; open machines with steps=acts");
}

SubmissionOrder submission_of(const LogWords& words, const std::string& settings) {
  SubmissionOrder order;
  order.about = words.about;
  order.unit = words.origin.unit;
  order.settings = settings_without_seed(settings);
  return order;
}

std::shared_ptr<LogWriter> begin_writer(const LineService& service, std::string_view name,
                                        SubmissionOrder order) {
  if (!service.recorder)
    refuse_log("this server keeps no files; it was started without --record-dir; log inline needs none");
  try {
    return service.recorder->begin_log(std::string(name), std::move(order), service.limits.recording);
  } catch (const std::runtime_error& error) {
    refuse_log(error.what());
  }
}

void begin_log(Context& context, std::string_view name, LogWords words, Reply& reply) {
  LoadedMachine& loaded = *context.game.loaded;
  Slot& slot = words.machine ? context.machines.slot(*words.machine) : loaded.slot();
  Pacer& pacer = words.machine ? context.machines.pacer(*words.machine) : loaded.pacer();
  check_game(context, slot);
  const Environment& machine = slot.environment();
  PlaySettings settings = context.game.settings;
  settings.life_loss = slot.settings().life_loss;
  settings.machine.truncate_on_life_loss = machine.settings().truncate_on_life_loss;
  words.origin.agent = words.about.agent;
  words.origin.version = context.service.version;
  words.origin.unit =
      machine.game().name + '-' + words.about.agent + '-' + std::to_string(words.origin.trial);
  context.memory.check(kMaxLogBytes, "a log");
  std::shared_ptr<LogWriter> writer;
  if (name != kInMemory)
    writer = begin_writer(context.service, name,
                          submission_of(words, words_of(settings_of_log(settings, machine), machine)));
  context.media.log = std::make_unique<SessionLog>(SessionLog::Order{words.origin, words.about.phrase},
                                                   settings, writer, slot, pacer, context.service.memory);
  context.media.log->await(context.pacer);
  if (writer && writer->finished()) {
    context.media.log.reset();
    refuse_log(writer->result().failure);
  }
  reply.add("log", name);
  reply.add("unit", words.origin.unit);
}

void stop_log(Context& context, Reply& reply) {
  SessionLog& log = *context.media.log;
  log.leave();
  LogWriter* const writer = log.writer();
  if (writer != nullptr) writer->finish();
  log.await(context.pacer);
  const auto ended = std::move(context.media.log);
  const SessionLog::Counts counts = ended->counts();
  const auto cut = writer != nullptr ? writer->cut() : std::nullopt;
  const int logged = writer != nullptr ? writer->result().logged : counts.logged;
  reply.add("logged", logged);
  reply.add("unlogged", counts.unlogged + counts.logged - logged);
  if (writer != nullptr) reply.add("bytes", static_cast<std::int64_t>(writer->result().bytes));
  reply.add("complete", cut ? 0 : 1);
  if (cut) reply.add("log_ended", name_of(*cut));
}

void hand_over(Context& context, Reply& reply) {
  const EpisodeLog& log = context.media.log->last();
  context.memory.check(4 * (log.actions.size() + 4 * log.strengths.size() + 8 * log.hashes.size()), "a log");
  const std::string bytes = bytes_of(log, [&context] { context.pacer.yield_if_due(); });
  context.check_reply(text_size(Encoding::kBase64, bytes.size()), "a log");
  std::string row = line_of(row_of(log, sha256_of(bytes)));
  row.pop_back();
  reply.add("unit", log.origin.unit);
  reply.add("episode", log.origin.episode);
  reply.add("row", row);
  reply.add("bytes", static_cast<std::int64_t>(bytes.size()));
  append_base64(reply.add_long("data"), std::vector<std::uint8_t>(bytes.begin(), bytes.end()));
}

}  // namespace

void run_log(Context& context, Words arguments, Reply& reply) {
  const std::string_view name = arguments[0];
  const bool is_stop = name == "stop", is_last = name == "last";
  if (is_stop || is_last) {
    if (arguments.size() > 1)
      throw RequestError(ErrorCode::kBadArguments, quote(arguments[1]) + " is not accepted here; log " +
                                                       std::string(name) + " takes no further words");
    if (!context.media.log) refuse_log("no episodes are being logged; log NAME or log inline begins that");
    return is_stop ? stop_log(context, reply) : hand_over(context, reply);
  }
  if (context.media.log) refuse_log("episodes are logged already; log stop ends it");
  begin_log(context, checked_name(name, "submission"), read_log_words(context, arguments.subspan(1)), reply);
}

}  // namespace racebeam
