#include "racebeam/error.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <string>
#include <vector>

#include "tests/library/beamfall.hpp"

using racebeam::Error;
using Cause = racebeam::Error::Cause;

namespace {

// The cause and the sentence of the Error that `work` throws.
std::pair<Cause, std::string> error_of(auto work) {
  try {
    work();
  } catch (const Error& error) {
    return {error.cause(), error.what()};
  }
  FAIL("nothing was thrown");
  return {};
}

}  // namespace

TEST_CASE("An image that cannot be read is an error of the image") {
  const auto [cause, sentence] = error_of([] { racebeam::Image::load("/nonexistent/pong.bin"); });
  CHECK(cause == Cause::kImage);
  CHECK(sentence.find("/nonexistent/pong.bin") != std::string::npos);
  CHECK(error_of([] { racebeam::Image::from_bytes({}, "empty"); }).first == Cause::kImage);
  CHECK(error_of([] { racebeam::Image::load("builtin:pong"); }).second.find("builtin:beamfall") !=
        std::string::npos);
}

TEST_CASE("An unknown game is an error of the game, which suggests similar names") {
  const auto [cause, sentence] = error_of([] { racebeam::Game::named("breakuot"); });
  CHECK(cause == Cause::kGame);
  CHECK(sentence == "unknown game 'breakuot'; did you mean breakout?");
  CHECK(error_of([] { racebeam::Game::load("/nonexistent/pong.toml"); }).first == Cause::kGame);
}

TEST_CASE("Settings that a game cannot have are an error of the settings") {
  racebeam::Settings settings;
  settings.frame_skip = -1;
  const auto play = [&] { racebeam::Environment environment(beamfall::image(), settings); };
  CHECK(error_of(play) == std::pair{Cause::kSettings, std::string("frame_skip is -1; it must be 1 or more")});
  const auto none = [] { racebeam::VectorEnvironment vector(std::span<const racebeam::Cartridge>{}); };
  CHECK(error_of(none).first == Cause::kSettings);
}

TEST_CASE("A snapshot of something else is an error of the snapshot, and changes nothing") {
  auto environment = beamfall::environment();
  beamfall::score_of(environment, 10);
  const auto before = environment.state_hash();
  racebeam::Environment other(racebeam::Image::load("builtin:updraft"));
  const auto of_other = other.save();
  CHECK(error_of([&] { environment.restore(of_other); }).first == Cause::kSnapshot);
  CHECK(error_of([&] { environment.restore(racebeam::Snapshot::from_bytes({})); }).first == Cause::kSnapshot);
  auto bytes = environment.save().to_bytes();
  bytes[200] ^= 1;
  CHECK(error_of([&] { environment.restore(racebeam::Snapshot::from_bytes(bytes)); }).first ==
        Cause::kSnapshot);
  CHECK(environment.state_hash() == before);
}

TEST_CASE("Arguments that are out of range are errors of the argument, which have the value") {
  auto environment = beamfall::environment();
  std::vector<std::uint8_t> small(5);
  const float infinite = std::numeric_limits<float>::infinity();
  for (const auto& [error, value] : {
           std::pair{error_of([&] { environment.step(static_cast<racebeam::Action>(26)); }), "26"},
           std::pair{error_of([&] { environment.step({.strength_a = infinite}); }), "is inf"},
           std::pair{error_of([&] { environment.observe(racebeam::Pixels::kGrey, small); }), "5 bytes"},
           std::pair{error_of([&] { environment.set_ram(128, 0); }), "128"},
           std::pair{error_of([&] { environment.set_ram(-1, 0); }), "-1"},
           std::pair{error_of([&] { environment.set_mode(77); }), "77"},
           std::pair{error_of([&] { environment.set_difficulty(77); }), "77"},
       }) {
    CHECK(error.first == Cause::kArgument);
    CHECK_THAT(error.second, Catch::Contains(value));
  }
}
