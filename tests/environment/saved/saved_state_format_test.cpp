// A state as bytes: it is restored exactly, and other bytes are refused.
#include <zlib.h>
#include <catch2/catch.hpp>
#include <cstring>
#include <random>
#include <sstream>

#include "environment/saved/saved_state_format.hpp"
#include "environment/saved_state.hpp"
#include "games/md5.hpp"
#include "tests/support/counter_image.hpp"
#include "tests/support/observation.hpp"

namespace racebeam {
namespace {

using Bytes = std::vector<std::uint8_t>;

Environment counter(const std::string& name = "steered") {
  Settings settings;
  settings.random_seed = 5;
  return {test::counter_image(), test::game(test::kSteeredGame, name), settings};
}

Bytes some_state(bool with_random = false) {
  Environment environment = counter();
  for (int i = 0; i < 10; ++i) environment.act(i);
  return to_bytes(*environment.save(with_random), environment);
}

TEST_CASE("Bytes of a state give the same bytes again") {
  Environment environment = counter();
  for (const bool with_random : {false, true}) {
    const Bytes bytes = some_state(with_random);
    const auto saved = from_bytes(bytes, environment);
    CHECK(to_bytes(*saved, environment) == bytes);
    CHECK((saved->random != nullptr) == with_random);
    environment.restore(*saved);
    CHECK(to_bytes(*environment.save(with_random), environment) == bytes);
  }
}

TEST_CASE("A state carries its generator through bytes") {
  Environment first = counter(), second = counter();
  for (int i = 0; i < 700; ++i) first.act(i % 18);  // past one turn of the generator's 624 words
  second.restore(*from_bytes(to_bytes(*first.save(true), first), second));
  CHECK(*second.save(true)->random == *first.save(true)->random);
}

// GNU's library writes a generator as these words in decimal, and racebeam 0.1 took them from there.
TEST_CASE("The generator's bytes are the words of MT19937 and the position") {
  Environment environment = counter();
  constexpr int kActs = 400;  // of a frame, with two draws each
  for (int i = 0; i < kActs; ++i) environment.act(i % 18);
  const MersenneTwister random = *environment.save(true)->random;
  const Bytes bytes = to_bytes(*environment.save(true), environment);
  constexpr std::size_t kNumbers = 625;
  std::array<std::uint32_t, kNumbers> numbers;
  std::memcpy(numbers.data(), bytes.data() + bytes.size() - sizeof numbers, sizeof numbers);
  CHECK(std::ranges::equal(std::span(numbers).first(kNumbers - 1), random.words()));
  CHECK(numbers.back() == random.position());
#ifdef __GLIBCXX__
  std::mt19937 standard(5);  // the environment's seed
  standard.discard(2 * kActs);
  std::stringstream text;
  text << standard;
  for (const std::uint32_t number : numbers) {
    std::uint32_t expected = 0;
    text >> expected;
    REQUIRE(number == expected);
  }
#endif
}

// 4K of CommaVid's scheme: counts frames in cartridge RAM that does not fit into a state, and shows the count
// at $80.
std::shared_ptr<const Image> image_with_ram() {
  std::vector<std::uint8_t> bytes(4096, 0xEA);
  bytes[0] = 100;  // first contents of the RAM
  const std::uint8_t code[] = {0xA9, 0x02, 0x85, 0x00, 0x85, 0x02, 0x85, 0x02, 0xA9,
                               0x00, 0x85, 0x00,                                      // VSYNC
                               0xAE, 0x00, 0xF0, 0xE8, 0x8E, 0x00, 0xF4, 0x86, 0x80,  // count
                               0x4C, 0x00, 0xF8, 0x9D, 0xFF, 0xF3};                   // again; signature
  std::ranges::copy(code, bytes.begin() + 2048);
  bytes[4093] = bytes[4095] = 0xF8;
  bytes[4092] = bytes[4094] = 0x00;
  Image image{std::make_shared<const std::vector<std::uint8_t>>(bytes), md5_of(bytes), "ram"};
  return std::make_shared<const Image>(std::move(image));
}

TEST_CASE("A state has the cartridge's RAM, in memory and as bytes") {
  Environment environment(image_with_ram(), test::game(), {});
  environment.set_ram(0x11, 0);  // the game is not over, whatever was there at power-on
  environment.reset_game();
  for (int i = 0; i < 10; ++i) environment.act(0);
  const auto saved = environment.save();
  const int count = environment.ram()[0];
  const Bytes bytes = to_bytes(*saved, environment);
  for (int i = 0; i < 5; ++i) environment.act(0);
  REQUIRE(int{environment.ram()[0]} == count + 5);

  Environment other(image_with_ram(), test::game(), {});
  for (Environment* restored : {&environment, &other}) {
    restored->restore(*from_bytes(bytes, *restored));
    CHECK(to_bytes(*restored->save(), *restored) == bytes);
    for (int i = 0; i < 5; ++i) restored->act(0);
    CHECK(int{restored->ram()[0]} == count + 5);
  }
  environment.restore(*saved);
  environment.act(0);
  CHECK(int{environment.ram()[0]} == count + 1);
}

TEST_CASE("Bytes that are not a state are refused") {
  const Environment environment = counter();
  const auto refusal = [&](const Bytes& bytes) { from_bytes(bytes, environment); };
  CHECK_THROWS_WITH(refusal({}), Catch::Contains("not a state"));
  CHECK_THROWS_WITH(refusal(Bytes(100, 0)), Catch::Contains("not a state"));
  CHECK_THROWS_WITH(refusal(Bytes(100000, 'x')), Catch::Contains("not a state"));
}

TEST_CASE("A state that was truncated, at any byte, is refused") {
  const Environment environment = counter();
  const Bytes bytes = some_state(true);
  for (std::size_t size = 0; size < bytes.size(); size += size < 400 ? 1 : 997) {
    CHECK_THROWS_AS(from_bytes(std::span(bytes).first(size), environment), std::invalid_argument);
  }
  CHECK_THROWS_WITH(from_bytes(std::span(bytes).first(bytes.size() - 1), environment),
                    Catch::Contains("was truncated"));
  Bytes longer = bytes;
  longer.push_back(0);
  CHECK_THROWS_WITH(from_bytes(longer, environment), Catch::Contains("bytes were added"));
}

TEST_CASE("A state that was altered, at any byte, is refused") {
  const Environment environment = counter();
  Bytes bytes = some_state(true);
  for (std::size_t i = 0; i < bytes.size(); i += i < 400 ? 1 : 499) {
    bytes[i] ^= 0x10;
    CHECK_THROWS_AS(from_bytes(bytes, environment), std::invalid_argument);
    bytes[i] ^= 0x10;
  }
  bytes[5000] ^= 1;
  CHECK_THROWS_WITH(from_bytes(bytes, environment), Catch::Contains("altered"));
}

TEST_CASE("A state of another format is refused by its number") {
  Bytes bytes = some_state();
  const std::uint32_t version = 77;
  std::memcpy(&bytes[8], &version, sizeof version);
  CHECK_THROWS_WITH(
      from_bytes(bytes, counter()),
      Catch::Contains("format 77") && Catch::Contains("reads format " + std::to_string(kSnapshotVersion)));
}

TEST_CASE("A state of the same format with other values is of another build") {
  Bytes bytes = some_state();
  std::uint32_t size = 0;
  std::memcpy(&size, &bytes[12], sizeof size);
  const std::string here = std::to_string(size), there = std::to_string(--size);
  std::memcpy(&bytes[12], &size, sizeof size);
  CHECK_THROWS_WITH(from_bytes(bytes, counter()),
                    Catch::Contains("another build of racebeam (with " + there +
                                    " bytes of values; this one reads " + here + ")"));
}

TEST_CASE("The image and the game that a state names are printable text") {
  Bytes bytes = some_state();
  const std::size_t name = 24 + sizeof(Identity::md5);
  bytes[name] = '\x1B';
  bytes[name + 1] = '\n';
  const auto sum =
      static_cast<std::uint32_t>(crc32(0, bytes.data() + 24, static_cast<uInt>(bytes.size() - 24)));
  std::memcpy(bytes.data() + 20, &sum, sizeof sum);
  CHECK_THROWS_WITH(from_bytes(bytes, counter()),
                    Catch::Contains("the game \\x1b\\x0aeered; the one that runs is steered"));
}

TEST_CASE("A state of another game or image is refused") {
  CHECK_THROWS_WITH(from_bytes(some_state(), counter("other")),
                    "the state is of the game steered; the one that runs is other");
}

}  // namespace
}  // namespace racebeam
