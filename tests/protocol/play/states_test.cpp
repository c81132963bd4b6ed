// States that a session keeps by name: what refusals say, and what they leave.
#include <catch2/catch.hpp>
#include <string>

#include "tests/protocol/line_client.hpp"

using namespace racebeam;
using test::code;
using test::kLoad;
using test::LineClient;

namespace {

// Keeps this many states: s10, s11 and so on.
std::string keep(LineClient& client, int count) {
  std::string names;
  for (int number = 10; number < 10 + count; ++number) {
    const std::string name = "s" + std::to_string(number);
    CHECK(client.ask("save " + name) == "ok state=" + name);
    names += " " + name;
  }
  return names;
}

}  // namespace

TEST_CASE("An unknown state is refused with the names of twenty") {
  LineClient client;
  client.ask(kLoad);
  CHECK(client.ask("restore other") == "error no-state unknown state 'other'; accepted: none");
  const std::string names = keep(client, 20);
  CHECK(client.ask("restore other") == "error no-state unknown state 'other'; accepted:" + names);
  client.ask("save zzz");
  CHECK(client.ask("restore other") ==
        "error no-state unknown state 'other'; accepted:" + names + " and more");
  CHECK(client.ask("restore zzy") ==
        "error no-state unknown state 'zzy'; did you mean zzz? Accepted:" + names + " and more");
}

TEST_CASE("A drop with an unknown name drops nothing, and one without drops what it names") {
  LineClient client;
  client.ask(kLoad);
  keep(client, 4);
  CHECK(code(client.ask("drop s10 other")) == "no-state");
  CHECK(client.ask("states") == "ok count=4 states=s10,s11,s12,s13");
  CHECK(client.ask("drop s13 s10 s13") == "ok count=2");
  CHECK(client.ask("states") == "ok count=2 states=s11,s12");
  CHECK(code(client.ask("drop all s11")) == "no-state");
  CHECK(client.ask("drop all") == "ok count=0");
  CHECK(client.ask("states") == "ok count=0 states=");
}

TEST_CASE("A branch needs a list of actions, also where it keeps the ends") {
  LineClient client;
  client.ask(kLoad);
  client.ask("save a");
  CHECK(client.ask("branch a keep=end") == "error bad-arguments branch takes at least one list of actions");
  CHECK(code(client.ask("branch a keep=end NOOP")) == "");
  CHECK(client.ask("states") == "ok count=2 states=a,end0");
}

TEST_CASE("save takes the generator as 0 or 1, once") {
  LineClient client;
  client.ask(kLoad);
  CHECK(client.ask("save a generator=2") ==
        "error bad-value generator is '2'; it takes a whole number from 0 to 1");
  CHECK(client.ask("save a generator=1 generator=1") == "error bad-arguments generator is given twice");
  CHECK(client.ask("states") == "ok count=0 states=");
  CHECK(client.ask("save a generator=0") == "ok state=a");
}
