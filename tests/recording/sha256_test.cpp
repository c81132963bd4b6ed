#include "recording/sha256.hpp"

#include <catch2/catch.hpp>
#include <fstream>

#include "tests/games/scratch.hpp"

using namespace racebeam;

TEST_CASE("SHA-256 is that of the standard") {
  // The examples of FIPS 180-2: a block, two blocks, and many.
  CHECK(sha256_of("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(sha256_of("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq") ==
        "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  CHECK(sha256_of(std::string(1'000'000, 'a')) ==
        "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_CASE("The SHA-256 of a file is that of its bytes") {
  const Scratch place;
  const std::string contents(200'000, 'x');
  std::ofstream(place.path("file")) << contents;
  CHECK(sha256_of_file("table", place.path("file")) == sha256_of(contents));
  CHECK_THROWS_WITH(sha256_of_file("table", place.path("none")), Catch::Contains("no such file"));
}
