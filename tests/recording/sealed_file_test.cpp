#include "recording/sealed_file.hpp"

#include <catch2/catch.hpp>

#include "system/invalid_input.hpp"
#include "tests/games/scratch.hpp"

using namespace racebeam;

namespace {

constexpr SealedKind kKind = {.what = "test", .magic = "RBTESTED", .version = 3, .most = 1000, .level = 9};

std::string refusal_of(const SealedKind& kind, std::string_view bytes) {
  try {
    unseal(kind, "file", bytes);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("Sealed contents come back") {
  for (const std::string& contents : {std::string(), std::string("a"), std::string(1000, 'x')})
    CHECK(unseal(kKind, "file", seal(kKind, contents)) == contents);
}

TEST_CASE("Sealing pauses between pieces, and the file is the same") {
  SealedKind large = kKind;
  large.most = std::size_t{1} << 20;
  std::string contents;
  for (std::uint32_t number = 1; contents.size() < 100'000; number = number * 1664525 + 1013904223)
    contents += static_cast<char>(number >> 28);
  int pauses = 0;
  const std::string sealed = seal(large, contents, [&] { ++pauses; });
  CHECK(pauses == 6);
  CHECK((unseal(large, "file", sealed) == contents));
  CHECK((seal(large, contents) == sealed));
}

TEST_CASE("A file of the most contents can be read, even if they do not deflate") {
  const Scratch folder;
  std::string contents;
  for (std::uint32_t number = 1; contents.size() < kKind.most; number = number * 1664525 + 1013904223)
    contents += static_cast<char>(number >> 24);
  const std::string path = folder.write("file", seal(kKind, contents));
  CHECK((read_sealed(kKind, path) == contents));
  CHECK_THROWS_WITH(read_sealed(kKind, folder.write("long", std::string(2000, 'x'))),
                    Catch::Contains("larger than"));
}

TEST_CASE("Every altered bit and every cut of a sealed file is refused") {
  const std::string sealed = seal(kKind, "some contents that are long enough, long enough to be deflated");
  for (std::size_t bit = 0; bit < 8 * sealed.size(); ++bit) {
    std::string altered = sealed;
    altered[bit / 8] = static_cast<char>(altered[bit / 8] ^ (1 << bit % 8));
    REQUIRE(refusal_of(kKind, altered) != "");
  }
  for (std::size_t size = 0; size < sealed.size(); ++size)
    REQUIRE(refusal_of(kKind, sealed.substr(0, size)) != "");
  CHECK(refusal_of(kKind, sealed + 'x') == "test file: its checksum is wrong; it was cut or altered");
}

TEST_CASE("A sealed file of another version or kind says so") {
  SealedKind later = kKind;
  later.version = 4;
  CHECK(refusal_of(kKind, seal(later, "x")) == "test file: it is of version 4; this program reads version 3");
  CHECK(refusal_of(kKind, std::string(100, 'x')).starts_with("test file: it does not begin with RBTESTED"));
}

TEST_CASE("Contents that would be too large are refused before memory is taken") {
  SealedKind large = kKind;
  large.most = std::size_t{1} << 20;
  const std::string bomb = seal(large, std::string(1 << 20, '\0'));
  CHECK(refusal_of(kKind, bomb) == "test file: it says that it holds 1048576 bytes; accepted: at most 1000");
  CHECK_THROWS_AS(seal(kKind, std::string(1001, 'x')), std::runtime_error);
}
