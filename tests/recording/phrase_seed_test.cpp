#include "recording/phrase_seed.hpp"

#include <catch2/catch.hpp>
#include <string>

#include "system/invalid_input.hpp"

using namespace racebeam;

// The first 32 bits of the SHA-256 of the four parts, one a line, as Python's hashlib gives them.
TEST_CASE("A seed is made of the digest of the phrase, the game, the trial and the episode") {
  CHECK(seed_of_phrase("words", "pong", 1, 2) == 685309688);   // 28d8fef8...
  CHECK(seed_of_phrase("words", "pong", 1, 3) == 2141272577);  // without the highest bit
}

TEST_CASE("A phrase has 1 to 1000 plain bytes") {
  for (const std::string& phrase : {std::string(1, ' '), std::string("!"), std::string("~"),
                                    std::string("\xC3\xA4"), std::string(1000, 'a')})
    CHECK(is_phrase(phrase));
  for (const std::string& other :
       {std::string(), std::string(1001, 'a'), std::string("a\"b"), std::string("a\\b"), std::string("a\nb"),
        std::string("\x1F"), std::string("\x7F")}) {
    CHECK_FALSE(is_phrase(other));
    CHECK_THROWS_AS(check_phrase(other), InvalidInput);
  }
  CHECK_NOTHROW(check_phrase("words"));
}
