// Each old word of protocol/protocol.toml is taken for the new one. help marks it, and the log warns once.
#include "protocol/line/old_words.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <string>
#include <vector>

#include "tests/protocol/duel.hpp"

using namespace racebeam;
using Catch::Matchers::Contains;
using test::code;
using test::duel_service;
using test::kLoad;
using test::LineClient;
using test::value;

namespace {

using description::kOldWords;

struct Pair {
  std::string before;            // requests
  std::string old_way, new_way;  // conversations
};

const std::string kLoaded = "load duel seed=7 sticky=0.5 max_episode_frames=3",
                  kStateBoth = kLoaded + "\nact RIGHT*2\n",
                  kMany = "load beamfall seed=7 sticky=0 frame_skip=900\nobserve terminated lives\n",
                  kOneMore = "\nact RIGHT*9\nact RIGHT*9\nlook episode_frame",
                  kStep = "\nstep FIRE\nstep FIRE";

// The key is the command and the old word. `seed` and `life_loss_ends` have their own cases.
const std::map<std::string, Pair> kPairs = {
    {"load autoreset=0",
     {"", kLoaded + " autoreset=0" + kOneMore, kLoaded + " autoreset=disabled" + kOneMore}},
    {"load autoreset=1",
     {"", kLoaded + " autoreset=1" + kOneMore, kLoaded + " autoreset=next-step" + kOneMore}},
    {"save random",
     {kStateBoth, "save a random=1\nact RIGHT\nrestore a\nexport a",
      "save a generator=1\nact RIGHT\nrestore a\nexport a"}},
    {"export whole", {kStateBoth + "save a\n", "export a whole=1", "export a episode=1"}},
    {"open autoreset=0", {kMany, "open 1 autoreset=0" + kStep, "open 1 autoreset=disabled" + kStep}},
    {"open autoreset=1", {kMany, "open 1 autoreset=1" + kStep, "open 1 autoreset=next-step" + kStep}},
    {"open lives=told",
     {kMany, "open 1 steps=frames lives=told" + kStep, "open 1 steps=frames life_loss=reported" + kStep}},
    {"open life_loss=told",
     {kMany, "open 1 steps=frames life_loss=told" + kStep, "open 1 steps=frames life_loss=reported" + kStep}},
    {"open lives",
     {kMany, "open 1 steps=frames lives=end" + kStep, "open 1 steps=frames life_loss=end" + kStep}},
    {"field ends", {kStateBoth, "look ends lives", "look terminated truncated lives"}},
    {"field grey84", {kStateBoth, "observe grey84:hex\nact NOOP", "observe grey84x84x1:hex\nact NOOP"}},
    {"field grey84xN", {kStateBoth, "observe grey84x3:hex\nact NOOP", "observe grey84x84x3:hex\nact NOOP"}},
};

std::string name_of(const OldWord& row) { return std::string(row.of) + ' ' + std::string(row.old); }

// Without the names of fields, which are as the request wrote them.
std::string without_names(std::string text) {
  for (const std::string name : {"grey84x84x1", "grey84x84x3", "grey84x3", "grey84"}) {
    for (std::size_t at = 0; (at = text.find(name + "=", at)) != text.npos;) text.erase(at, name.size());
    if (text.starts_with("ok fields=" + name)) text.erase(10, name.size());
  }
  return text;
}

std::string answer(const std::string& before, const std::string& conversation) {
  LineClient client(duel_service());
  client.say(before);
  return without_names(client.say(conversation + "\n"));
}

struct Logged {  // a server, and what it logs of old words
  Logged() : service(duel_service()) {
    service.report_old_word = [this](const std::string& sentence) { sentences.push_back(sentence); };
  }
  LineService service;
  std::vector<std::string> sentences;
};

}  // namespace

TEST_CASE("An old word is answered as the new one is") {
  for (const OldWord& row : kOldWords) {
    const std::string name = name_of(row);
    INFO(name);
    if (!row.is_same || row.old == "seed=0") continue;
    REQUIRE(kPairs.contains(name));
    const Pair& pair = kPairs.at(name);
    const std::string old_reply = answer(pair.before, pair.old_way);
    CHECK_THAT(old_reply, !Contains("error "));
    CHECK(old_reply == answer(pair.before, pair.new_way));
  }
}

TEST_CASE("seed=0 of load is a random seed, and elsewhere the seed 0") {
  LineClient client;
  CHECK(value(client.ask("load beamfall seed=0"), "seed") != "0");
  client.ask("reset seed=0");
  CHECK(value(client.ask("settings"), "seed") == "0");
}

TEST_CASE("help marks each old word") {
  LineClient client;
  for (const OldWord& row : kOldWords) {
    const std::string name(row.old.substr(0, row.old.find('=')));
    INFO(name);
    CHECK_THAT(client.ask("help " + (name == "grey84xN" ? "grey84x4" : name)),
               Contains("deprecated: use " + std::string(row.now)));
  }
}

TEST_CASE("help tells a word that is only an old one from a field") {
  LineClient client;
  CHECK(client.ask("help ends") == "ok an old word: field ends is deprecated: use terminated truncated");
  CHECK_THAT(client.ask("help lives"), Contains("; old: open lives is deprecated: use life_loss"));
}

TEST_CASE("The log warns of an old word once, whatever session uses it") {
  Logged server;
  for (int session = 0; session < 2; ++session) {
    LineClient client(server.service);
    client.say(kLoad + "\nsave a random=1\nsave b random=1\nsave c generator=1\nobserve grey84x2 ends\n");
  }
  CHECK(server.sentences ==
        std::vector<std::string>{
            "a client uses an old word: save random is deprecated: use generator",
            "a client uses an old word: field grey84xN is deprecated: use grey84x84xN",
            "a client uses an old word: field ends is deprecated: use terminated truncated"});
}

TEST_CASE("The log warns of each old word") {
  for (const OldWord& row : kOldWords) {
    const std::string name = name_of(row);
    INFO(name);
    Logged server;
    LineClient client(server.service);
    if (kPairs.contains(name)) {
      client.say(kPairs.at(name).before + kPairs.at(name).old_way + "\n");
    } else {
      client.say("load duel " + std::string(row.old) + (row.is_same ? "" : "=1") + "\n");
    }
    CHECK_THAT(server.sentences,
               Catch::Matchers::VectorContains("a client uses an old word: " + deprecation_of(row)));
  }
}

TEST_CASE("An old word and the new one are one key") {
  LineClient client;
  client.ask(kLoad);
  CHECK(client.ask("open 1 lives=end life_loss=reported") == "error bad-arguments life_loss is given twice");
  CHECK(client.ask("open 1 lives=three") ==
        "error bad-value life_loss is 'three'; it takes ignored, reported, end or restart");
}
