#include "system/words.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <limits>

#include "system/named_rows.hpp"

using namespace racebeam;
using Catch::Matchers::Message;

namespace {

constexpr std::array<std::string_view, 3> kFruit = {"apple", "pear", "plum"};

struct Row {
  std::string_view name;
};
constexpr std::array<Row, 2> kRows = {{{"one"}, {"two"}}};

}  // namespace

TEST_CASE("Words are what stands between blanks") {
  std::vector<std::string_view> words = {"old"};
  split("  act  FIRE*3 ", words);
  CHECK(words == std::vector<std::string_view>{"act", "FIRE*3"});
  std::string_view line = "a b";
  CHECK(next_word(line) == "a");
  CHECK(next_word(line) == "b");
  CHECK(next_word(line).empty());
}

TEST_CASE("A number is the whole word, and finite") {
  CHECK(parse_number<int>("12") == 12);
  CHECK(parse_number<double>("-0.5") == -0.5);
  for (const char* const text : {"", "12x", " 12", "+12", "9999999999"}) CHECK_FALSE(parse_number<int>(text));
  for (const char* const text : {"nan", "inf", "1e999"}) CHECK_FALSE(parse_number<double>(text));
}

TEST_CASE("A number within limits may be either limit") {
  CHECK(number_within("1", "N", 1, 3) == 1);
  CHECK(number_within("3", "N", 1, 3) == 3);
  CHECK(number_within("0", "N", 0, 3) == 0);
  for (const char* const text : {"0", "4", "x"})
    CHECK_THROWS_MATCHES(number_within(text, "N", 1, 3), InvalidInput,
                         Message("N is '" + std::string(text) + "'; it takes a whole number from 1 to 3"));
  CHECK_THROWS_AS(number_within("-0", "N", 0, 3), InvalidInput);
}

TEST_CASE("A word that does not belong is told from a value that is not accepted") {
  CHECK_THROWS_MATCHES(key_value("seed"), InvalidArguments, Message("'seed' is not of the form key=value"));
  CHECK_THROWS_MATCHES(value_of("sead=1", "seed", "reset"), InvalidArguments,
                       Message("'sead=1' is not accepted here; reset takes seed="));
  CHECK_THROWS_MATCHES(refuse_twice("seed"), InvalidArguments, Message("seed is given twice"));
  CHECK_THROWS_MATCHES(refuse_name("fruit", "aple", kFruit), InvalidArguments,
                       Message("unknown fruit 'aple'; did you mean apple? Accepted: apple pear plum"));
  try {
    choice_of("lemon", "fruit", kFruit);
    FAIL("a lemon is not accepted");
  } catch (const InvalidArguments&) {
    FAIL("it is the value that is wrong");
  } catch (const InvalidInput& error) {
    CHECK(error.what() == std::string("fruit is 'lemon'; it takes apple, pear or plum"));
  }
  CHECK_THROWS_WITH(choice_of("pera", "fruit", kFruit),
                    "fruit is 'pera'; did you mean pear? It takes apple, pear or plum");
  CHECK(unknown_name("fruit", "lemon", kFruit) == "unknown fruit 'lemon'; accepted: apple pear plum");
  for (const char* const word : {"seed", "seeds=1", "see=1", "=1", ""})
    CHECK_THROWS_AS(value_of(word, "seed", "reset"), InvalidArguments);
}

TEST_CASE("A value is found by its word, and the word by the value") {
  constexpr std::array<WordFor<int>, 2> kNumbers = {{{"one", 1}, {"two", 2}}};
  CHECK(value_for("two", "number", kNumbers) == 2);
  CHECK_THROWS_WITH(value_for("six", "number", kNumbers), Catch::StartsWith("number is 'six'; "));
  CHECK(word_for(kNumbers, 2) == "two");
  CHECK(word_for(kNumbers, 3).empty());
}

TEST_CASE("A pair is cut at the first '='") {
  CHECK(key_value("a=b=c").key == "a");
  CHECK(key_value("a=b=c").value == "b=c");
  CHECK(key_value("=").key.empty());
  CHECK(value_of("seed=", "seed", "reset").empty());
  CHECK(choice_of("plum", "fruit", kFruit) == 2);
}

TEST_CASE("A name has at most 64 letters") {
  const std::string longest(64, 'a');
  CHECK(checked_name(longest, "state") == longest);
  const std::string letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_";
  CHECK(checked_name(letters, "state") == letters);
  for (int code = 0; code < 256; ++code) {
    const std::string letter(1, static_cast<char>(code));
    INFO(code);
    if (letters.find(letter) == std::string::npos)
      CHECK_THROWS_AS(checked_name(letter, "state"), InvalidInput);
  }
  for (const std::string& text : {longest + 'a', std::string(), std::string("a b"), std::string("a/b")})
    CHECK_THROWS_AS(checked_name(text, "state"), InvalidInput);
}

TEST_CASE("Bytes have two digits each") {
  CHECK(bytes_of_hex("0aFF") == std::vector<std::uint8_t>{0x0A, 0xFF});
  CHECK(bytes_of_hex("").empty());
  for (const char* const text : {"0", "0g", "0x0", "-1", "+1"})
    CHECK_THROWS_AS(bytes_of_hex(text), InvalidInput);
}

TEST_CASE("A quote is shortened after 40 bytes") {
  CHECK(quote(std::string(40, 'x')) == "'" + std::string(40, 'x') + "'");
  CHECK(quote(std::string(41, 'x')) == "'" + std::string(40, 'x') + "...'");
}

TEST_CASE("The case of ASCII letters changes, and other bytes stay") {
  CHECK(lower_case("aZ[`{\xC4") == "az[`{\xC4");
  CHECK(upper_case("aZ[`{\xE4") == "AZ[`{\xE4");
}

TEST_CASE("Words are joined, with another text before the last one") {
  CHECK(join(kFruit, ", ") == "apple, pear, plum");
  CHECK(join(kFruit, ", ", " and ") == "apple, pear and plum");
  CHECK(join(std::vector<std::string>{"apple"}, ", ", " and ") == "apple");
  CHECK(join(std::vector<std::string>{}, ", ").empty());
}

TEST_CASE("Text after a mark is cut off") {
  std::string_view text = "a,b,c";
  CHECK(cut_behind(text, ',') == "b,c");
  CHECK(text == "a");
  CHECK(cut_behind(text, ',').empty());
  CHECK(text == "a");
}

TEST_CASE("Numbers and pairs are written as they are read") {
  std::string out;
  append_number(out, 0.1);
  append_pair(out, "n", std::int64_t{-7});
  append_pair(out, "t", "x");
  out += ' ';
  append_list(out, std::array{1, 2, 3});
  CHECK(out == "0.1 n=-7 t=x 1,2,3");
  out.clear();
  append_list(out, std::array<int, 0>{});
  append_number(out, std::numeric_limits<std::int64_t>::min());
  CHECK(out == "-9223372036854775808");
}

TEST_CASE("Tables have rows by name") {
  CHECK(names_of(kRows) == std::vector<std::string_view>{"one", "two"});
  STATIC_REQUIRE(&row_named(kRows, "two") == &kRows[1]);
  STATIC_REQUIRE(same_names(kRows, kRows));
  STATIC_REQUIRE_FALSE(same_names(kRows, std::array<Row, 2>{{{"two"}, {"one"}}}));
}
