#include "recording/claim.hpp"

#include <catch2/catch.hpp>

using namespace racebeam;

namespace {

using Names = std::vector<std::string>;

}  // namespace

TEST_CASE("A name is claimed until its claim ends") {
  const auto claims = std::make_shared<Claims>();
  CHECK(claims->empty());
  {
    const Claim claim(claims, {"a.gif", "b"});
    CHECK_FALSE(claims->empty());
    CHECK_THROWS_WITH(claims->add({"b"}), "b is being recorded already; choose another name");
  }
  CHECK(claims->empty());
  CHECK_NOTHROW(Claim(claims, {"b"}));
}

TEST_CASE("A folder is taken with all that is in it, and with the folders above it") {
  const auto claims = std::make_shared<Claims>();
  const Claim claim(claims, {"films/today"});
  for (const std::string taken : {"films", "films/today", "films/today/1.gif"}) {
    INFO(taken);
    CHECK_THROWS_AS(claims->add({taken}), std::runtime_error);
  }
  for (const std::string free : {"film", "films/today1", "films/toda", "films-today", "today"}) {
    INFO(free);
    CHECK_NOTHROW(Claim(claims, {free}));
  }
}

TEST_CASE("There are at most as many names as the claims allow") {
  const auto claims = std::make_shared<Claims>(2);
  const Claim claim(claims, {"first"});
  CHECK_THROWS_WITH(claims->add({"second", "third"}),
                    "the server would record into 3 files at the same time; the limit is 2; try again later");
  {
    const Claim second(claims, {"second"});
    CHECK_THROWS_AS(claims->add({"third"}), std::runtime_error);
  }
  CHECK_NOTHROW(claims->add({"third"}));
}

TEST_CASE("Several names are claimed together, or not at all") {
  const auto claims = std::make_shared<Claims>();
  const Claim claim(claims, {"taken"});
  CHECK_THROWS_AS(claims->add({"first", "taken", "last"}), std::runtime_error);
  CHECK_NOTHROW(claims->add({"first", "last"}));
  claims->drop({"first"});
  CHECK_NOTHROW(claims->add({"first"}));
  CHECK_THROWS_AS(claims->add({"last"}), std::runtime_error);
}
