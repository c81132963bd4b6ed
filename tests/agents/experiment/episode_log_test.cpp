#include "recording/episode_log.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "recording/sealed_file.hpp"
#include "system/input_file.hpp"
#include "system/invalid_input.hpp"
#include "tests/agents/experiment/samples.hpp"

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

}  // namespace

TEST_CASE("A log is read as it was written") {
  const EpisodeLog log = random_log(short_episodes());
  const EpisodeLog read = log_of("1.episode", bytes_of(log));
  CHECK(read.game == log.game);
  CHECK(read.image_md5 == log.image_md5);
  CHECK(read.settings == log.settings);
  CHECK(read.origin.unit == log.origin.unit);
  CHECK(read.origin.agent_seed == log.origin.agent_seed);
  CHECK(read.end == log.end);
  CHECK(read.hashes == log.hashes);
  CHECK(read.actions == log.actions);
  CHECK(bytes_of(read) == bytes_of(log));
}

TEST_CASE("Strengths are read as they were written, and must be finite") {
  EpisodeLog log = random_log(short_episodes());
  log.strengths.assign(log.actions.size(), 0.5F);
  log.strengths.back() = -1e30F;
  CHECK(log_of("1.episode", bytes_of(log)).strengths == log.strengths);
  CHECK(log_of("1.episode", bytes_of(log)).actions == log.actions);
  log.strengths.front() = std::numeric_limits<float>::infinity();
  CHECK(refusal_of(bytes_of(log)) == "episode log 1.episode: it has a strength that is not a finite number");
}

TEST_CASE("Every byte of a log counts") {
  const std::string bytes = bytes_of(random_log(short_episodes(500)));
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    for (const int flip : {1, 0x80, 0xFF}) {
      std::string altered = bytes;
      altered[at] = static_cast<char>(altered[at] ^ flip);
      REQUIRE(refusal_of(altered) != "");
    }
  }
}

TEST_CASE("A log that is cut anywhere is refused") {
  const std::string bytes = bytes_of(random_log(short_episodes(500)));
  for (std::size_t size = 0; size < bytes.size(); ++size) REQUIRE(refusal_of(bytes.substr(0, size)) != "");
}

TEST_CASE("Sealed contents that are not an episode are refused with a sentence") {
  const std::string good = unseal(kSame, "", bytes_of(random_log(short_episodes(500))));
  CHECK(refusal_of(seal(kSame, "")) ==
        "episode log 1.episode: its contents are not an episode: the line 'load' is missing");
  std::string wrong = good;
  wrong.replace(wrong.find("trial=1"), 7, "trial=x");
  CHECK(refusal_of(seal(kSame, wrong)).find("trial is 'x'") != std::string::npos);
  wrong = good;
  wrong.back() = 38;
  CHECK(refusal_of(seal(kSame, wrong)) ==
        "episode log 1.episode: it has action 38; accepted: 0 to 37, and those with more buttons");
  CHECK(refusal_of(seal(kSame, good + '\0')).find("a hash, an action or a strength is missing") !=
        std::string::npos);
  for (std::size_t size = 0; size < good.size(); ++size)
    REQUIRE(refusal_of(seal(kSame, good.substr(0, size))) != "");
}

TEST_CASE("A file of a gibibyte is refused unread") {
  const Scratch folder;
  const std::string path = folder.path("1.episode");
  write(path, bytes_of(random_log(short_episodes(500))));
  std::filesystem::resize_file(path, std::size_t{1} << 30);
  CHECK_THROWS_AS(read_input_file("episode log", path, kMostLogBytes), InputFileError);
}

TEST_CASE("A log of 18,000 random frames takes at most 12 KiB") {
  PlaySettings play = short_episodes(18000);
  play.machine.frame_skip = 1;
  EpisodeLog log = random_log(play);
  Random random(1);
  while (log.actions.size() < 18000) log.actions.push_back(static_cast<std::uint8_t>(random.below(18)));
  log.end.decisions = 18000;
  while (log.hashes.size() < hashes_of(18000)) log.hashes.push_back(random.next());
  CHECK(bytes_of(log).size() <= 12 * 1024);
}
