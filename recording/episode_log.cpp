#include "recording/episode_log.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>

#include "games/game/actions.hpp"
#include "recording/sealed_file.hpp"
#include "system/invalid_input.hpp"
#include "system/words.hpp"

namespace racebeam {
namespace {

constexpr SealedKind kKind = {
    .what = "episode log", .magic = "RBEPISOD", .version = 1, .most = std::size_t{2} << 20, .level = 9};
constexpr std::array<WordFor<EpisodeOver>, 2> kOvers = {
    {{"terminated", EpisodeOver::kTerminated}, {"truncated", EpisodeOver::kTruncated}}};
constexpr std::int64_t kMaxInt = std::numeric_limits<int>::max();
constexpr std::int64_t kMax64 = std::numeric_limits<std::int64_t>::max();
constexpr std::int64_t kMaxSeed = std::numeric_limits<std::uint32_t>::max();

// Appends a number, the lowest byte first.
template <class Number>
void append_bytes(std::string& out, Number number) {
  for (unsigned byte = 0; byte < sizeof number; ++byte)
    out += static_cast<char>(static_cast<std::uint8_t>(number >> (8 * byte)));
}

template <class Number>
Number number_at(std::string_view bytes) {
  Number number = 0;
  for (unsigned byte = 0; byte < sizeof number; ++byte)
    number |= static_cast<Number>(Number{static_cast<std::uint8_t>(bytes[byte])} << (8 * byte));
  return number;
}

// Takes the text of a log apart. Throws InvalidInput.
class LogReader {
 public:
  explicit LogReader(std::string_view contents) : left_(contents) {}

  EpisodeLog read() {
    EpisodeLog log;
    log.settings = line("load");
    log.game = cut_first_word(log.settings);
    log.image_md5 = line("image");
    read_origin(log.origin);
    read_end(log.end);
    if (!line("").empty()) fail("an empty line");
    read_bytes(log);
    return log;
  }

 private:
  [[noreturn]] static void fail(const std::string& expected) {
    throw InvalidInput("its contents are not an episode: " + expected + " is missing");
  }

  // The rest of the next line, which begins with `word`.
  std::string line(std::string_view word) {
    const std::size_t end = left_.find('\n');
    if (end == std::string_view::npos || !left_.starts_with(word))
      fail("the line '" + std::string(word) + "'");
    std::string_view text = left_.substr(word.size(), end - word.size());
    left_.remove_prefix(end + 1);
    if (!word.empty()) {
      if (!text.starts_with(' ')) fail("the line '" + std::string(word) + "'");
      text.remove_prefix(1);
    }
    return std::string(text);
  }

  static std::string cut_first_word(std::string& text) {
    std::string_view rest = text;
    const std::string word(next_word(rest));
    text = std::string(rest.substr(std::min(rest.find_first_not_of(' '), rest.size())));
    return word;
  }

  // The value of the next word key=value.
  static std::string_view value(std::string_view& rest, std::string_view key) {
    const KeyValue pair = key_value(next_word(rest));
    if (pair.key != key) fail(std::string(key));
    return pair.value;
  }

  void read_origin(EpisodeOrigin& origin) {
    const std::string text = line("from");
    std::string_view rest = text;
    origin.unit = value(rest, "unit");
    origin.agent = value(rest, "agent");
    origin.trial = static_cast<int>(number_within(value(rest, "trial"), "trial", 1, kMaxInt));
    origin.episode = static_cast<int>(number_within(value(rest, "episode"), "episode", 1, kMaxInt));
    origin.agent_seed =
        static_cast<std::uint32_t>(number_within(value(rest, "agent_seed"), "agent_seed", 0, kMaxSeed));
    origin.version = value(rest, "version");
  }

  void read_end(EpisodeEnd& end) {
    const std::string text = line("ended");
    std::string_view rest = text;
    end.score = number_within(value(rest, "score"), "score", -kMax64, kMax64);
    end.frames = number_within(value(rest, "frames"), "frames", 0, kMaxInt);
    end.decisions = number_within(value(rest, "decisions"), "decisions", 0, kMaxInt);
    end.over = value_for(value(rest, "end"), "end", kOvers);
    end.lives = static_cast<int>(number_within(value(rest, "lives"), "lives", -kMaxInt, kMaxInt));
  }

  void read_bytes(EpisodeLog& log) {
    const auto decisions = static_cast<std::size_t>(log.end.decisions);
    const std::size_t hashes = hashes_of(decisions), least = 8 * hashes + decisions;
    if (left_.size() != least && left_.size() != least + 4 * decisions)
      fail("a hash, an action or a strength");
    for (std::size_t i = 0; i < hashes; ++i)
      log.hashes.push_back(number_at<std::uint64_t>(left_.substr(8 * i)));
    for (const char byte : left_.substr(8 * hashes, decisions)) {
      const auto action = static_cast<std::uint8_t>(byte);
      if (!is_action(action))
        throw InvalidInput("it has action " + std::to_string(action) +
                           "; accepted: 0 to 37, and those with more buttons");
      log.actions.push_back(action);
    }
    for (std::size_t at = least; at < left_.size(); at += 4) {
      const auto strength = std::bit_cast<float>(number_at<std::uint32_t>(left_.substr(at)));
      if (!std::isfinite(strength)) throw InvalidInput("it has a strength that is not a finite number");
      log.strengths.push_back(strength);
    }
  }

  std::string_view left_;
};

}  // namespace

const std::size_t kMaxLogBytes = kKind.most;

std::string_view name_of(EpisodeOver over) { return word_for(kOvers, over); }

std::size_t hashes_of(std::size_t decisions) { return decisions / kDecisionsPerStretch + 1; }

std::string bytes_of(const EpisodeLog& log, const std::function<void()>& pause) {
  std::string out = "load " + log.game + ' ' + log.settings + "\nimage " + log.image_md5 + "\nfrom";
  append_pair(out, "unit", log.origin.unit);
  append_pair(out, "agent", log.origin.agent);
  append_pair(out, "trial", log.origin.trial);
  append_pair(out, "episode", log.origin.episode);
  append_pair(out, "agent_seed", std::int64_t{log.origin.agent_seed});
  append_pair(out, "version", log.origin.version);
  out += "\nended";
  append_pair(out, "score", log.end.score);
  append_pair(out, "frames", log.end.frames);
  append_pair(out, "decisions", log.end.decisions);
  append_pair(out, "end", name_of(log.end.over));
  append_pair(out, "lives", log.end.lives);
  out += "\n\n";
  for (const std::uint64_t hash : log.hashes) append_bytes(out, hash);
  out.append(log.actions.begin(), log.actions.end());
  for (const float strength : log.strengths) append_bytes(out, std::bit_cast<std::uint32_t>(strength));
  return seal(kKind, out, pause);
}

EpisodeLog log_of(const std::string& name, std::string_view bytes) {
  const std::string contents = unseal(kKind, name, bytes);
  try {
    return LogReader(contents).read();
  } catch (const InvalidInput& error) {
    throw InvalidInput("episode log " + name + ": " + error.what());
  }
}

namespace {

// Episodes of logs are played with the properties of the image (check_episode_settings()).
bool is_console_key(std::string_view name) {
  constexpr std::array<std::string_view, 6> kKeys = {"scheme", "left", "right", "format", "ystart", "height"};
  return std::ranges::find(kKeys, name) != kKeys.end();
}

// Whether another word says the same as this setting. Logs have the words of version 0.1 where these suffice.
bool is_said_otherwise(std::string_view name, const PlaySettings& settings) {
  const bool is_new = settings.life_loss != LifeLoss::kIgnored;
  return (name == "life_loss" && !is_new) || (name == "life_loss_ends" && is_new);
}

// The value of a row that is not taken from the machine. Mode and difficulty are written only if they were
// set, since setting them begins another episode.
std::optional<std::int64_t> own_value(std::string_view name, const PlaySettings& settings) {
  if (name == "seed") return settings.machine.random_seed;
  return name == "mode" ? settings.mode : settings.difficulty;
}

}  // namespace

std::string words_of(const PlaySettings& settings, const Environment& machine) {
  constexpr std::array<std::string_view, 3> kOwn = {"seed", "mode", "difficulty"};
  std::string out;
  for (const SettingRow& row : setting_rows()) {
    const bool own = std::ranges::find(kOwn, row.name) != kOwn.end();
    const auto value = own ? own_value(row.name, settings) : std::nullopt;
    if (row.name == "preset" || is_console_key(row.name) || (own && !value)) continue;
    if (is_said_otherwise(row.name, settings)) continue;
    ((out += out.empty() ? "" : " ") += row.name) += '=';
    own ? append_number(out, *value) : row.append(out, settings, machine);
  }
  return out;
}

std::string settings_without_seed(const std::string& settings) {
  std::vector<std::string_view> words;
  split(settings, words);
  std::ranges::sort(words);
  std::string text;
  for (const std::string_view word : words)
    if (key_value(word).key != "seed") (text += text.empty() ? "" : " ") += word;
  return text;
}

}  // namespace racebeam
