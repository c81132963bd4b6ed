#include "system/similar.hpp"

#include <catch2/catch.hpp>

using namespace racebeam;

namespace {

using Names = std::vector<std::string_view>;

Names similar(std::string_view name, const Names& candidates) { return similar_names(name, candidates); }

}  // namespace

TEST_CASE("A name is similar by letters that are inserted, deleted and replaced, whatever their case") {
  const Names pong = {"pong"};
  for (const char* const name : {"pong", "PONG", "ping", "png", "poong", "ponk", "pigg"}) {
    INFO(name);
    CHECK(similar(name, pong) == pong);
  }
  CHECK(similar("pppp", pong).empty());
  CHECK(similar("pingk", {"Pong"}) == Names{"Pong"});
}

TEST_CASE("The longer a name is, the more letters may differ, but never as many as the shorter name has") {
  CHECK(similar("", {"", "a"}).empty());
  CHECK(similar("a", {"b", "ab"}).empty());
  CHECK(similar("a", {"A"}) == Names{"A"});
  CHECK(similar("ab", {"ac", "cd"}) == Names{"ac"});
  CHECK(similar("abc", {"axy", "xyz"}) == Names{"axy"});
  CHECK(similar("jump", {"up", "noop"}).empty());
  CHECK(similar("jup", {"up"}) == Names{"up"});
  CHECK(similar("abcdefgh", {"abcdefxy"}).size() == 1);  // a third of eight letters is two
  CHECK(similar("abcdefgh", {"abcdexyz"}).empty());
  CHECK(similar("abcdefghi", {"abcdefxyz"}).size() == 1);
  CHECK(similar("abcdefghi", {"abcdewxyz"}).empty());
}

TEST_CASE("A name is similar to those that begin with it, if it has three letters") {
  CHECK(similar("spa", {"space_invaders"}).size() == 1);
  CHECK(similar("sp", {"space_invaders"}).empty());
  CHECK(similar("spx", {"space_invaders"}).empty());
  CHECK(similar("space_invaders", {"spa"}).empty());
}

TEST_CASE("At most three names are similar, the nearest first, and those much farther away are not") {
  CHECK(similar("pong", {"pxny", "pony", "pong"}) == Names{"pong", "pony"});
  CHECK(similar("pong", {"pxny", "pony"}) == Names{"pony", "pxny"});
  CHECK(similar("pon1", {"pon5", "pon4", "pon3", "pon2"}) == Names{"pon2", "pon3", "pon4"});
}

TEST_CASE("A name of more than 64 letters is not similar to any") {
  const std::string longest(64, 'a'), longer(65, 'a');
  CHECK(similar(longest, {longer}).size() == 1);
  CHECK(similar(longer, {longest}).empty());
}

TEST_CASE("A question names what is similar") {
  CHECK(did_you_mean("pon1", Names{"pon3", "pon2"}) == " did you mean pon2 or pon3?");
  CHECK(did_you_mean("qqq", Names{"pong"}).empty());
}
