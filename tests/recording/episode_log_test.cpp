#include "recording/episode_log.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <utility>

#include "recording/sealed_file.hpp"
#include "system/input_file.hpp"
#include "system/invalid_input.hpp"
#include "tests/games/scratch.hpp"
#include "tests/recording/film.hpp"
#include "tests/recording/sample_log.hpp"

using namespace racebeam;
using namespace racebeam::test;

namespace {

constexpr SealedKind kSame = {
    .what = "episode log", .magic = "RBEPISOD", .version = 1, .most = std::size_t{2} << 20, .level = 9};

std::string refusal_of(const std::string& bytes) {
  try {
    log_of("1.episode", bytes);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

// What a log's text is, before it is compressed; and with one part replaced, the refusal of it.
std::string contents_of(const EpisodeLog& log) { return unseal(kSame, "", bytes_of(log)); }

std::string refusal_with(const std::string& part, const std::string& other) {
  std::string text = contents_of(sample_log());
  text.replace(text.find(part), part.size(), other);
  return refusal_of(seal(kSame, text));
}

}  // namespace

TEST_CASE("A log is read as it was written") {
  for (const int decisions : {0, 1, 255, 256, 300}) {
    const EpisodeLog log = sample_log(decisions);
    const EpisodeLog read = log_of("1.episode", bytes_of(log));
    CHECK(read.game == log.game);
    CHECK(read.image_md5 == log.image_md5);
    CHECK(read.settings == log.settings);
    CHECK(read.origin.unit == log.origin.unit);
    CHECK(read.origin.agent == log.origin.agent);
    CHECK(read.origin.trial == 2);
    CHECK(read.origin.episode == 3);
    CHECK(read.origin.agent_seed == log.origin.agent_seed);
    CHECK(read.origin.version == log.origin.version);
    CHECK(read.end == log.end);
    CHECK(read.hashes == log.hashes);
    CHECK(read.actions == log.actions);
    CHECK(read.strengths.empty());
    CHECK(bytes_of(read) == bytes_of(log));
  }
}

TEST_CASE("A log has a hash after each 256 decisions, and one at the end") {
  for (const auto& [decisions, hashes] : {std::pair(0, 1), {255, 1}, {256, 2}, {511, 2}, {512, 3}})
    CHECK(hashes_of(static_cast<std::size_t>(decisions)) == static_cast<std::size_t>(hashes));
}

TEST_CASE("Strengths are read as they were written, and must be finite") {
  EpisodeLog log = sample_log();
  log.strengths.assign(log.actions.size(), 0.5F);
  log.strengths.back() = -1e30F;
  CHECK(log_of("1.episode", bytes_of(log)).strengths == log.strengths);
  CHECK(log_of("1.episode", bytes_of(log)).actions == log.actions);
  log.strengths.front() = std::numeric_limits<float>::infinity();
  CHECK(refusal_of(bytes_of(log)) == "episode log 1.episode: it has a strength that is not a finite number");
}

TEST_CASE("Every byte of a log counts") {
  const std::string bytes = bytes_of(sample_log());
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    for (const int flip : {1, 0x80, 0xFF}) {
      std::string altered = bytes;
      altered[at] = static_cast<char>(altered[at] ^ flip);
      REQUIRE(refusal_of(altered) != "");
    }
  }
}

TEST_CASE("A log that is cut anywhere is refused") {
  const std::string bytes = bytes_of(sample_log());
  for (std::size_t size = 0; size < bytes.size(); ++size) REQUIRE(refusal_of(bytes.substr(0, size)) != "");
}

TEST_CASE("Sealed contents that are not an episode are refused with a sentence") {
  const std::string good = contents_of(sample_log());
  CHECK(refusal_of(seal(kSame, "")) ==
        "episode log 1.episode: its contents are not an episode: the line 'load' is missing");
  CHECK(refusal_with("trial=2", "trial=x").find("trial is 'x'") != std::string::npos);
  for (const char* word : {"load", "image", "from", "ended"}) {
    const std::string missing = "the line '" + std::string(word) + "' is missing";
    CHECK(refusal_with(word, "else").find(missing) != std::string::npos);
    CHECK(refusal_with(std::string(word) + ' ', std::string(word) + '-').find(missing) != std::string::npos);
  }
  for (const std::string key : {"unit", "agent", "trial", "episode", "agent_seed", "version", "score",
                                "frames", "decisions", "end", "lives"})
    CHECK(refusal_with(' ' + key + '=', " other=").find(": " + key + " is missing") != std::string::npos);
  CHECK(refusal_with("\n\n", "\nmore\n").find("an empty line is missing") != std::string::npos);
  std::string wrong = good;
  wrong.back() = 38;
  CHECK(refusal_of(seal(kSame, wrong)) ==
        "episode log 1.episode: it has action 38; accepted: 0 to 37, and those with more buttons");
  for (const std::string& size : {good + '\0', good.substr(0, good.size() - 1)})
    CHECK(refusal_of(seal(kSame, size)).find("a hash, an action or a strength is missing") !=
          std::string::npos);
  for (std::size_t size = 0; size < good.size(); ++size)
    REQUIRE(refusal_of(seal(kSame, good.substr(0, size))) != "");
}

TEST_CASE("Numbers of a log have limits, which are accepted") {
  const struct {
    const char *part, *accepted, *refused;
  } rows[] = {
      {"trial=2", "trial=1", "trial=0"},
      {"trial=2", "trial=2147483647", "trial=2147483648"},
      {"episode=3", "episode=1", "episode=0"},
      {"episode=3", "episode=2147483647", "episode=2147483648"},
      {"agent_seed=4294967295", "agent_seed=0", "agent_seed=-1"},
      {"agent_seed=4294967295", "agent_seed=4294967295", "agent_seed=4294967296"},
      {"score=-50", "score=-9223372036854775807", "score=-9223372036854775808"},
      {"score=-50", "score=9223372036854775807", "score=9223372036854775808"},
      {"frames=1200", "frames=0", "frames=-1"},
      {"frames=1200", "frames=2147483647", "frames=2147483648"},
      {"decisions=300", "decisions=300", "decisions=-1"},
      {"lives=5", "lives=-2147483647", "lives=-2147483648"},
      {"lives=5", "lives=2147483647", "lives=2147483648"},
      {"end=terminated", "end=truncated", "end=other"},
  };
  for (const auto& [part, accepted, refused] : rows) {
    INFO(accepted);
    CHECK(refusal_with(part, accepted).empty());
    CHECK(refusal_with(part, refused) != "");
  }
}

TEST_CASE("A file of a gibibyte is refused unread") {
  const Scratch folder;
  const std::string path = folder.write("1.episode", bytes_of(sample_log()));
  std::filesystem::resize_file(path, std::size_t{1} << 30);
  CHECK_THROWS_AS(read_input_file("episode log", path, kMaxLogBytes), InputFileError);
}

TEST_CASE("A log of 18,000 random frames takes at most 12 KiB") {
  CHECK(bytes_of(sample_log(18000)).size() <= 12 * 1024);
}

TEST_CASE("A log has the settings of the machine, but mode and difficulty only if they were set") {
  const Environment machine = test::beamfall();
  const auto words = [&machine](const PlaySettings& settings) {
    const std::string text = ' ' + words_of(settings, machine) + ' ';
    return [text](const std::string& word) { return text.find(' ' + word) != std::string::npos; };
  };
  PlaySettings settings;
  settings.machine.random_seed = 9;
  settings.machine.frame_skip = 5;
  const auto plain = words(settings);
  CHECK(plain("seed=9 "));
  CHECK(plain("frame_skip=5 "));
  CHECK(plain("life_loss_ends=0 "));
  for (const char* const absent :
       {"mode=", "difficulty=", "life_loss=", "preset=", "scheme=", "left=", "right=", "format="}) {
    INFO(absent);
    CHECK_FALSE(plain(absent));
  }
  settings.mode = 0;
  settings.difficulty = 1;
  set_life_loss(settings, LifeLoss::kRestart);
  const auto chosen = words(settings);
  CHECK(chosen("mode=0 "));
  CHECK(chosen("difficulty=1 "));
  CHECK(chosen("life_loss=restart "));
  CHECK_FALSE(chosen("life_loss_ends="));
}

TEST_CASE("Settings without the seed are sorted, so that two logs of one plan have the same") {
  CHECK(settings_without_seed("sticky=0 seed=3 frame_skip=4") == "frame_skip=4 sticky=0");
  CHECK(settings_without_seed("frame_skip=4 system_seed=3 seed=4") == "frame_skip=4 system_seed=3");
  CHECK(settings_without_seed("seed=3").empty());
}
