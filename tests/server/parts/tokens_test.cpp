#include "server/access/tokens.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "tests/games/scratch.hpp"

using namespace racebeam;
using Catch::Matchers::EndsWith;

namespace {

const std::string kShort(16, 'a'), kLong(1024, 'b');

Tokens tokens_of(const Scratch& folder, const std::string& text) {
  return Tokens(folder.write("tokens", text));
}

void check_refused(const Scratch& folder, const std::string& text, const std::string& sentence) {
  CHECK_THROWS_WITH(Tokens(folder.write("tokens", text)), EndsWith(sentence));
}

constexpr auto kAccepted = ": a token must have 16 to 1024 printable characters and no blanks";

}  // namespace

TEST_CASE("A token is admitted as a whole, and no other text is") {
  const Scratch folder;
  const Tokens tokens(folder.write("tokens", kShort + "\n" + kLong + "\n"));
  CHECK(tokens.count() == 2);
  for (const std::string& token : {kShort, kLong}) {
    CHECK(tokens.admits(token));
    CHECK_FALSE(tokens.admits(token + token[0]));
    CHECK_FALSE(tokens.admits(token.substr(1)));
    CHECK_FALSE(tokens.admits(token.substr(0, token.size() / 2)));
    CHECK_FALSE(tokens.admits(std::string(token).replace(token.size() - 1, 1, "c")));
  }
  CHECK_FALSE(tokens.admits(""));
}

TEST_CASE("The ends of lines and blanks after a token do not belong to it") {
  const Scratch folder;
  for (const std::string end : {"\n", "\r\n", "  \n", " \r\n", "\r \n", ""}) {
    INFO(Catch::StringMaker<std::string>::convert(end));
    const Tokens tokens(folder.write("tokens", kShort + end));
    CHECK(tokens.admits(kShort));
    CHECK(tokens.count() == 1);
  }
}

TEST_CASE("Empty lines and comments are not tokens") {
  const Scratch folder;
  const std::string comment = "#" + kShort;
  const Tokens tokens(folder.write("tokens", comment + "\n\n\r\n  \n" + kShort + "\n"));
  CHECK(tokens.count() == 1);
  CHECK_FALSE(tokens.admits(comment));
  CHECK_FALSE(tokens.admits(kShort.substr(1)));
  for (const std::string& text : {std::string(), std::string("\n"), comment + "\n"})
    check_refused(folder, text, folder.path("tokens") + " has no token");
}

TEST_CASE("A line that is not a token is named by its number") {
  const Scratch folder;
  for (const std::string& wrong : {kShort.substr(1), kLong + 'b', kShort + " c", " " + kShort, kShort + '\t',
                                   kShort + '\x7F', kShort + '\xE9'}) {
    check_refused(folder, kShort + "\n\n" + wrong + "\n" + kLong + "\n",
                  "tokens, line 3" + std::string(kAccepted));
  }
  check_refused(folder, kShort + "\r" + kShort, "tokens, line 1" + std::string(kAccepted));
  CHECK(tokens_of(folder, "!" + kShort.substr(2) + "~").count() ==
        1);  // the first and the last that are printable
}

TEST_CASE("A file is read again, and a wrong one changes nothing") {
  const Scratch folder;
  const std::string own(20, 'o'), next(20, 'n');
  Tokens tokens(folder.write("tokens", kShort), own);
  CHECK(tokens.count() == 2);
  CHECK(tokens.admits(own));
  folder.write("tokens", next + "\nshort\n");
  CHECK_THROWS(tokens.read_again());
  CHECK(tokens.admits(kShort));
  CHECK_FALSE(tokens.admits(next));
  folder.write("tokens", next);
  tokens.read_again();
  CHECK(tokens.admits(next));
  CHECK(tokens.admits(own));
  CHECK_FALSE(tokens.admits(kShort));
  CHECK(tokens.count() == 2);
}

TEST_CASE("Without a file, only the server's own token is admitted") {
  const std::string own(20, 'o');
  CHECK(Tokens("", own).admits(own));
  CHECK(Tokens("", own).count() == 1);
  CHECK(Tokens("").count() == 0);
  CHECK_FALSE(Tokens("").admits(""));
}

TEST_CASE("A random token has 256 bits, and all of them vary") {
  constexpr int kDraws = 200;
  std::set<std::string> tokens;
  std::array<std::set<char>, 64> digits;
  for (int draw = 0; draw < kDraws; ++draw) {
    const std::string token = random_token();
    REQUIRE(token.size() == digits.size());
    REQUIRE(token.find_first_not_of("0123456789abcdef") == std::string::npos);
    for (std::size_t place = 0; place < digits.size(); ++place) digits[place].insert(token[place]);
    tokens.insert(token);
  }
  CHECK(tokens.size() == kDraws);
  // A bit that does not vary leaves eight digits. That no more come by chance in 200 draws is less likely
  // than 1e-50.
  for (const auto& found : digits) CHECK(found.size() > 8);
}
