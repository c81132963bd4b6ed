#include "protocol/running/memory_budget.hpp"

#include <catch2/catch.hpp>

#include "protocol/encoding/base64.hpp"
#include "protocol/line/action.hpp"
#include "protocol/request_error.hpp"
#include "tests/protocol/line_client.hpp"

using namespace racebeam;
using namespace racebeam::test;

namespace {

constexpr std::uint64_t kMiB = 1 << 20;

LineService service_with(std::uint64_t bytes) {
  LineService service = line_service();
  service.memory = std::make_shared<MemoryBudget>(bytes);
  return service;
}

}  // namespace

TEST_CASE("A budget gives what it has, and no more") {
  MemoryBudget budget(100);
  CHECK(budget.take(60));
  CHECK_FALSE(budget.take(41));
  CHECK(budget.take(40));
  CHECK_FALSE(budget.take(1));
  budget.give_back(50);
  CHECK(budget.has(50));
  CHECK_FALSE(budget.has(51));
  budget.take_anyway(70);
  CHECK_FALSE(budget.has(0));
}

TEST_CASE("A budget that is exceeded gives nothing until enough has come back") {
  MemoryBudget budget(100);
  budget.take_anyway(150);
  for (const std::uint64_t bytes : {std::uint64_t{1}, std::uint64_t{50}, MemoryBudget::kNoLimit}) {
    CHECK_FALSE(budget.take(bytes));
    CHECK_FALSE(budget.take(bytes, 20));
    CHECK_FALSE(budget.has(bytes));
  }
  CHECK(budget.taken() == 150);
  CHECK(budget.shortage() == 150 - 94);  // a sixteenth, rounded down, is kept free
  budget.give_back(60);
  CHECK_FALSE(budget.take(11));
  CHECK(budget.has(10));
  CHECK(budget.take(10));
}

TEST_CASE("What is spared for others is neither given nor taken") {
  MemoryBudget budget(100);
  CHECK_FALSE(budget.take(81, 20));
  CHECK(budget.take(80, 20));
  CHECK_FALSE(budget.take(1, 20));
  CHECK(budget.take(20));
  CHECK_FALSE(budget.take(1, 20));
  CHECK(budget.taken() == 100);
}

TEST_CASE("The memory is short when more than fifteen sixteenths are taken") {
  MemoryBudget budget(160);
  budget.take_anyway(150);
  CHECK_FALSE(budget.is_short());
  budget.take_anyway(1);
  CHECK(budget.shortage() == 1);
  CHECK(budget.reserve() == 20);
  CHECK(budget.little() == kMiB);
  CHECK(MemoryBudget(kMiB << 10).little() == 2 * kMiB);
}

TEST_CASE("What a part takes, the whole has taken") {
  const auto whole = std::make_shared<MemoryBudget>(100);
  const auto owner = MemoryBudget::part(whole, "user 1");
  {
    const auto session = std::make_shared<MemoryBudget>(owner), other = std::make_shared<MemoryBudget>(owner);
    CHECK(MemoryBudget::part(whole, "user 1") == owner);
    CHECK(owner->parts() == 2);
    CHECK(whole->parts() == 1);
    CHECK(session->take(60));
    CHECK_FALSE(other->take(41));
    other->take_anyway(50);
    CHECK(owner->taken() == 110);
    CHECK(whole->taken() == 110);
    CHECK_FALSE(session->has(0));
    CHECK(session->shortage() == 16);
    session->give_back(60);
    other->give_back(50);
    CHECK_FALSE(whole->is_short());
  }
  CHECK(owner->parts() == 0);
  CHECK(whole->taken() == 0);
}

TEST_CASE("The last eighth is for owners that hold little") {
  const auto budget = std::make_shared<MemoryBudget>(64 * kMiB);
  MemoryShare large(budget), little(budget);
  CHECK_FALSE(large.grow(57 * kMiB));
  CHECK(large.grow(56 * kMiB));
  CHECK_FALSE(large.grow(1));
  CHECK_THROWS_WITH(
      large.check(4096, "it"),
      "it would take about 4 KiB of memory; the server's sessions hold 56 MiB, and may hold 56 MiB "
      "for one of this size");
  CHECK(little.grow(kMiB));
  CHECK_FALSE(little.grow(1));
  CHECK(large.bytes() == 56 * kMiB);
  CHECK(little.bytes() == kMiB);
  CHECK(budget->taken() == 57 * kMiB);
}

TEST_CASE("The last thirty-second is not for an owner that holds more than half") {
  const auto budget = std::make_shared<MemoryBudget>(64 * kMiB);
  const auto large = MemoryBudget::part(budget, "user 1"), other = MemoryBudget::part(budget, "user 2");
  large->take_anyway(61 * kMiB);
  MemoryShare one_more(std::make_shared<MemoryBudget>(large)), first(std::make_shared<MemoryBudget>(other));
  CHECK(one_more.grow(kMiB));
  CHECK_FALSE(MemoryShare(std::make_shared<MemoryBudget>(large)).grow(1));
  CHECK(first.grow(kMiB));
}

TEST_CASE("An owner is refused by a budget that others have exceeded") {
  const auto budget = std::make_shared<MemoryBudget>(64 * kMiB);
  MemoryShare share(budget);
  budget->take_anyway(100 * kMiB);
  CHECK_FALSE(share.grow(1));
  CHECK_FALSE(share.grow(2 * kMiB));
  CHECK(share.bytes() == 0);
  CHECK(share.is_short());
}

TEST_CASE("A share is given back when its owner ends") {
  const auto budget = std::make_shared<MemoryBudget>(100);
  {
    MemoryShare share(budget);
    share.set(30);
    CHECK(share.grow(20));
    CHECK_FALSE(share.grow(51));
    CHECK_THROWS_AS(share.check(51, "it"), RequestError);
    CHECK(budget->taken() == 50);
  }
  CHECK(budget->taken() == 0);
}

TEST_CASE("A request beyond the memory budget is refused, and the session continues") {
  const LineService service = service_with(8 * kMiB);
  LineClient client(service), other(service);
  CHECK(code(client.ask("load beamfall")) == "");
  CHECK(code(client.ask("open 200")) == "limit");
  CHECK(code(client.ask("step NOOP")) == "no-machines");
  CHECK(code(client.ask("open 4")) == "");
  CHECK(code(client.ask("observe grey84x16:zlib rgb:delta")) == "limit");
  CHECK(client.ask("observe") == "ok fields=reward,terminated,truncated,lives");
  CHECK(code(client.ask("step NOOP")) == "");
  int saved = 0;
  while (saved < 200 && code(client.ask("save s" + std::to_string(saved))).empty()) ++saved;
  CHECK(saved > 10);
  CHECK(saved < 200);
  CHECK(code(client.ask("branch s0 keep=leaf 0 1 2")) == "limit");
  CHECK_FALSE(client.ask("states").ends_with("leaf0"));
  CHECK(code(client.ask("act FIRE")) == "");
  CHECK(code(other.ask("load beamfall")) == "");  // it holds little
  const std::uint64_t remaining = 8 * kMiB - service.memory->taken();
  service.memory->take_anyway(remaining);
  CHECK(code(other.ask("load beamfall")) == "limit");
  CHECK(code(client.ask("drop all")) == "");
  CHECK(code(other.ask("load beamfall")) == "");
  service.memory->give_back(remaining);
}

TEST_CASE("Machines are charged with the RAM of their cartridges") {
  const LineService service = service_with(64 * kMiB);
  LineClient client(service);
  CHECK(code(client.ask("load beamfall scheme=3EX")) == "");
  CHECK(service.memory->taken() >= kMiB / 4);
  CHECK(code(client.ask("open 256")) == "limit");
  CHECK(code(client.ask("open 40")) == "");
  CHECK(service.memory->taken() >= 41 * kMiB / 4);
  service.memory->take_anyway(63 * kMiB);
  CHECK(code(client.ask("load beamfall scheme=3EX")) == "limit");
  CHECK(client.ask("close") == "ok");  // the machines are still there
  service.memory->give_back(63 * kMiB);
}

TEST_CASE("Machines are charged with what blended screens take") {
  const LineService service = service_with(64 * kMiB);
  LineClient client(service), plain(service);
  const auto taken_by = [&](LineClient& one, const std::string& load) {
    const std::uint64_t before = service.memory->taken();
    for (const std::string request : {load.c_str(), "observe screen", "open 16", "step NOOP", "step NOOP"})
      CHECK(code(one.ask(request)) == "");
    return service.memory->taken() - before;
  };
  const std::uint64_t without = taken_by(plain, "load beamfall seed=1");
  CHECK(taken_by(client, "load beamfall seed=1 color_averaging=1") >= without + 16 * 160 * 210);
}

TEST_CASE("Machines are charged with the samples of all frames") {
  const LineService service = service_with(64 * kMiB);
  LineClient client(service);
  client.ask("load beamfall sound=1 frame_skip=100");
  client.ask("observe audio_all:raw");
  client.ask("open 16");
  const std::uint64_t before = service.memory->taken();
  CHECK(client.ask("step NOOP").starts_with("ok "));
  CHECK(service.memory->taken() >= before + 2 * 16 * 51'200);  // in the machines, and in the reply
}

TEST_CASE("Old words of a request are charged, and are forgotten after it") {
  const LineService service = service_with(64 * kMiB);
  LineClient client(service);
  std::string line = "load beamfall";
  for (int n = 0; n < 50'000; ++n) line += " autoreset=0";
  CHECK(code(client.ask(line)) == "bad-arguments");
  client.ask("help act");  // the reader of lines has shrunk when it has read the next one
  client.session.release_caches();
  CHECK(service.memory->taken() < kMiB / 4);
  service.memory->take_anyway(51 * kMiB);
  CHECK(client.ask(line).starts_with("error limit a line of so many old words would take"));
  service.memory->give_back(51 * kMiB);
  CHECK(code(client.ask("load beamfall autoreset=0")) == "");
}

TEST_CASE("An image that a client sends is charged with the code that it is translated to") {
  const LineService service = service_with(64 * kMiB);
  LineClient client(service);
  std::vector<std::uint8_t> bytes = *service.images->find("beamfall")->image->bytes;
  bytes[3744] ^= 1;  // unused
  std::string unknown;
  append_base64(unknown, bytes);
  CHECK(code(client.ask("load inline image=" + unknown)) == "");
  const std::uint64_t loaded = service.memory->taken();
  CHECK(code(client.ask("act NOOP*60")) == "");
  CHECK(loaded > 8192);
  CHECK(loaded < kMiB / 2);
  CHECK(service.memory->taken() < 2 * kMiB);
}

TEST_CASE("An image that the server has is shared, also when a client sends it") {
  const LineService service = service_with(64 * kMiB);
  LineClient client(service), other(service);
  CHECK(code(client.ask("load beamfall")) == "");
  const std::uint64_t one = service.memory->taken();
  std::string image;
  append_base64(image, *service.images->find("beamfall")->image->bytes);
  CHECK(code(other.ask("load inline image=" + image)) == "");
  CHECK(service.memory->taken() < 2 * one);
}

TEST_CASE("A line without memory for it is skipped with an error, and the session goes on") {
  const LineService service = service_with(kMiB);
  LineClient client(service);
  // A transport reads into the space, and takes zero bytes for the end of the input.
  std::string text = std::string(900'000, 'x') + "\ngames\n", answers;
  while (!text.empty()) {
    const std::span<char> space = client.session.space();
    REQUIRE_FALSE(space.empty());
    const std::size_t count = std::min(space.size(), text.size());
    client.hand_in(text.substr(0, count));
    text.erase(0, count);
    answers += client.listen();
  }
  CHECK(code(answers) == "limit");
  CHECK(answers.find("\nok count=") != std::string::npos);
  LineClient rich(service_with(64 * kMiB));
  CHECK(code(rich.ask(std::string(900'000, 'x'))) == "unknown-command");
}

TEST_CASE("A line is skipped where the memory is taken by others, and there is always space for the next") {
  const LineService service = service_with(8 * kMiB);
  LineClient client(service);
  service.memory->take_anyway(8 * kMiB);
  CHECK(code(client.ask(std::string(9'000, 'x'))) == "limit");
  CHECK(client.ask("games").starts_with("ok"));
  service.memory->give_back(8 * kMiB);
}

TEST_CASE("A long line of few words needs memory for its image, and not for half a million words") {
  const LineService service = service_with(8 * kMiB);
  LineClient client(service);
  const std::string image((std::size_t{512} << 10) / 3 * 4, 'A');
  CHECK(code(client.ask("load inline image=" + image)) != "limit");
}

TEST_CASE("A line of very many words is refused where memory does not suffice for them") {
  const LineService service = service_with(4 * kMiB);
  LineClient client(service);
  client.ask("load beamfall");
  std::string line = "act";
  for (int n = 0; n < 100'000; ++n) line += " 0";
  CHECK(code(client.ask(line)) == "limit");
  CHECK(code(client.ask("act 0")) == "");
}

TEST_CASE("The words of a request count until the session rests") {
  const LineService service = service_with(64 * kMiB);
  LineClient client(service);
  client.ask("load beamfall");
  const std::uint64_t before = service.memory->taken();
  std::string line = "drop";
  for (int n = 0; n < 100'000; ++n) line += " a";
  CHECK(code(client.ask(line)) == "no-state");
  CHECK(service.memory->taken() > before + 100'000 * sizeof(std::string_view));
  CHECK(service.memory->taken() < before + 8 * kMiB);
  client.ask("help act");  // the reader of lines has shrunk when it has read the next one
  client.session.release_caches();
  CHECK(service.memory->taken() <= before);
}

TEST_CASE("The actions of a request count until the session rests") {
  LineService service = service_with(64 * kMiB);
  service.limits.request_frames = 1000;
  LineClient client(service);
  client.ask("load beamfall");
  std::string line = "act";
  for (int n = 0; n < 20'000; ++n) line += " 0";
  CHECK(code(client.ask(line)) == "limit");
  const std::uint64_t held = service.memory->taken();
  client.session.release_caches();
  CHECK(held - service.memory->taken() > 20'000 * (sizeof(std::string_view) + sizeof(Action)));
}

TEST_CASE("Machines that rest hold less, and play on") {
  const LineService service = service_with(64 * kMiB);
  LineClient client(service), without_rest;
  for (LineClient* each : {&client, &without_rest}) each->say("load beamfall seed=7\nopen 20\nstep FIRE\n");
  const std::uint64_t played = service.memory->taken();
  client.session.release_caches();
  CHECK(played - service.memory->taken() > 20 * 200 * sizeof(std::uint64_t));
  CHECK(client.ask("step FIRE*9") == without_rest.ask("step FIRE*9"));
}

TEST_CASE("A share counts with two copies of a screen, and a watcher with what it compares") {
  constexpr std::int64_t kScreen = 210 * 160;
  const LineService service = service_with(64 * kMiB);
  LineClient player(service), watcher(service);
  player.say("load beamfall\nlook screen\n");  // the machine draws its picture
  const auto more_after = [&](LineClient& client, const std::string& request) {
    const std::uint64_t before = service.memory->taken();
    CHECK(code(client.ask(request)) == "");
    return static_cast<std::int64_t>(service.memory->taken() - before);
  };
  const auto share = more_after(player, "share room");
  CHECK(share >= 2 * kScreen);
  CHECK(share < 3 * kScreen);
  CHECK(more_after(watcher, "watch room screen:delta") >= kScreen);
  CHECK(more_after(player, "unshare") == -share);
}

TEST_CASE("A state counts for as long as it is kept, and one of the same name takes its place") {
  const LineService service = service_with(64 * kMiB);
  LineClient client(service);
  client.ask("load beamfall");
  const auto taken_after = [&](const std::string& request) {
    CHECK(code(client.ask(request)) == "");
    return service.memory->taken();
  };
  taken_after("save a");
  const std::uint64_t without = taken_after("drop a"), with = taken_after("save a");
  CHECK(with > without);
  CHECK(taken_after("save a") == with);
  CHECK(taken_after("save b") == with + (with - without));
  CHECK(taken_after("drop b") == with);
  CHECK(taken_after("drop a") == without);
}

TEST_CASE("A branch is refused where memory does not suffice for its lists, or for its reply") {
  LineClient client(service_with(16 * kMiB));
  CHECK(code(client.ask("load beamfall max_episode_frames=0")) == "");
  CHECK(code(client.ask("save a")) == "");
  CHECK(code(client.ask("branch a 0*1999999")) == "limit");
  std::string lists, list = " 0";
  while (lists.size() < 300'000) lists += " 0";
  while (list.size() < 600'000) list += ",0";
  CHECK(code(client.ask("branch a" + lists)) == "limit");
  CHECK(code(client.ask("branch a" + list)) == "limit");
  CHECK(code(client.ask("branch a 0*20,1 2*30")) == "");
}

TEST_CASE("The reply of one act is counted before there is one") {
  const LineService service = service_with(32 * kMiB);
  LineClient client(service);
  for (const std::string encoding : {"hex", "rle", "delta", "base64", "zlib", "raw"}) {
    INFO(encoding);
    client.ask("load beamfall seed=1 sticky=0");
    CHECK(code(client.ask("observe rgb160x210x16:" + encoding)) == "");
    const std::uint64_t observed = service.memory->taken();
    client.hand_in("act NOOP*20\n");
    while (client.session.output().empty()) client.session.run();
    // The reply is there, and the client has not read it. A text of unknown length grows by doubling.
    const bool doubles = encoding == "rle" || encoding == "delta";
    CHECK(service.memory->taken() < observed * (doubles ? 2 : 1) + kMiB / 4);
    client.listen();
    CHECK(code(client.ask("observe none")) == "");
    client.session.release_caches();
    CHECK(service.memory->taken() < kMiB);
  }
}

TEST_CASE("All memory comes back") {
  const LineService service = service_with(64 * kMiB);
  {
    LineClient client(service);
    client.ask("load beamfall");
    client.ask("observe screen:hex rgb:zlib");
    client.ask("open 20");
    client.ask("step NOOP");
    for (int n = 0; n < 20; ++n) client.ask("save s" + std::to_string(n));
    const std::uint64_t busy = service.memory->taken();
    client.ask("close");
    client.ask("drop all");
    client.ask("observe none");
    client.session.release_caches();
    CHECK(service.memory->taken() < busy / 4);
    CHECK(service.memory->taken() < kMiB);
  }
  CHECK(service.memory->taken() == 0);
}
