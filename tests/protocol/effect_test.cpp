// All that protocol/PROTOCOL.md offers makes a difference. The tables of the program are gone over: each
// command, word of a command's arguments, setting, preset, field, encoding and error code needs a case here,
// and a server that ignored it would fail that case.
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "protocol/encoding/base64.hpp"
#include "protocol/encoding/encoding.hpp"
#include "protocol/line/commands/command_table.hpp"
#include "protocol/line/field.hpp"
#include "protocol/line/play_settings.hpp"
#include "recording/recorder.hpp"
#include "tests/protocol/duel.hpp"

using namespace racebeam;
using test::code;
using test::duel_service;
using test::LineClient;
using test::value;

namespace {

// Two conversations that differ in one thing only. `probe` is what both end with, and its reply is what must
// differ; without it, that of their own last line.
struct Case {
  std::string_view row;
  std::string one, other, probe = "";
};

using Cases = std::vector<Case>;

const std::string kLoad = "load duel seed=7 sticky=0";
const std::string kToken = "open-sesame";

std::string counter_as_text(int unused_byte = 0) {
  auto bytes = *test::counter_image()->bytes;
  bytes[0x800] = static_cast<std::uint8_t>(unused_byte);
  std::string text;
  append_base64(text, bytes);
  return text;
}

std::string state_as_text() {
  LineClient client(duel_service());
  client.say(kLoad + "\nact NOOP*9\nsave a\n");
  return value(client.ask("export a"), "data");
}

struct Room {  // where conversations are held
  Scratch folder;
  LineService service = duel_service();
  Room() { service.recorder = std::make_shared<Recorder>(folder.path("")); }
};

// The reply to the last line.
std::string last_reply(const LineService& service, const std::string& conversation) {
  LineClient client(service);
  std::string replies = client.say(conversation + "\n");
  REQUIRE(replies.ends_with('\n'));
  replies.pop_back();
  return replies.substr(replies.rfind('\n') + 1);
}

std::string joined(const std::string& first, const std::string& second) {
  return first + (first.empty() || second.empty() ? "" : "\n") + second;
}

void check_difference(const LineService& service, const Case& one, const std::string& before) {
  INFO(one.row);
  const std::string first = last_reply(service, joined(before, joined(one.one, one.probe)));
  const std::string second = last_reply(service, joined(before, joined(one.other, one.probe)));
  INFO(first.substr(0, 200));
  CHECK(first.starts_with("ok"));
  CHECK(first != second);
}

template <typename Rows>
void check_complete(const Cases& cases, const Rows& rows) {
  std::set<std::string_view> expected, found;
  for (const auto& row : rows) expected.insert(row);
  for (const Case& one : cases) found.insert(one.row);
  CHECK(found == expected);
}

// The commands, and "COMMAND WORD" for each word of their arguments.
std::vector<std::string> commands_and_words() {
  std::vector<std::string> all;
  for (const Command& command : commands()) {
    const std::string name(command.name);
    all.push_back(name);
    std::string word;
    for (const char c : std::string(command.arguments) + ' ') {
      if (std::isalnum(static_cast<unsigned char>(c)) || c == '-') {
        word += c;
      } else if (!word.empty()) {
        all.push_back(name + ' ' + std::exchange(word, ""));
      }
    }
  }
  return all;
}

const std::string kAlternating = "act RIGHT NOOP RIGHT NOOP RIGHT NOOP RIGHT NOOP",
                  kTetris = "load beamfall as=tetris seed=7 sticky=0",
                  kSticky = "load duel seed=7 sticky=0.5",
                  kAfterSave = "act RIGHT NOOP*9\nrestore a\nsave b random=1\nexport b",
                  kEnds = "load duel seed=7 sticky=0 max_episode_frames=2\nobserve episode_frame ends",
                  kThreeSteps = "step NOOP\nstep NOOP\nstep NOOP",
                  kOpen = "open 2\nobserve episode_frame\nstep NOOP";

const std::string
    kOtherSticky = "load duel seed=8 sticky=0.5",
    kManySticky = "load duel seed=8 sticky=0.5 frame_skip=20\nopen 9\n",
    kFrames = "load beamfall seed=7 sticky=0 frame_skip=4 noop_max=30\nobserve ram\n",
    kLongSteps = "load beamfall seed=7 sticky=0 frame_skip=900\nobserve ends lives episode_frame\n",
    kStart = "open 1 steps=frames start=", kLives = "open 1 steps=frames lives=",
    kStacked = "load beamfall seed=7 sticky=0 frame_skip=4\nobserve grey84x3:hex\nopen 1 steps=frames ";

const std::string kUneven = "load duel seed=7 sticky=0 frame_skip=1-9\nopen 2\n",
                  kFourSteps = "step NOOP\nstep NOOP\nstep NOOP\nstep NOOP\nrecord stop";

// Conversations before a game is loaded.
const Cases kFirst = {
    {"hello", "hello token=" + kToken, "", "stats"},
    {"hello token", "hello token=" + kToken, "hello", "stats"},
    {"hello TOKEN", "hello token=" + kToken, "hello token=guess", "stats"},
};

// Those with the game duel.
const Cases kPlaying = {
    {"help", "help", "stats"},
    {"help COMMAND", "help act", "help load"},
    {"help KEY", "help sticky", "help seed"},
    {"help settings", "help settings", "help presets"},
    {"help presets", "help presets", "help fields"},
    {"help fields", "help fields", "help encodings"},
    {"help encodings", "help encodings", "help errors"},
    {"help errors", "help errors", "help states"},
    {"help states", "help states", "help settings"},
    {"games", "games", "stats"},
    {"games all", "games all", "games"},
    {"games GAME", "games pong", "games boxing"},
    {"load", "load beamfall", "", "settings"},
    {"load GAME", "load beamfall", "load updraft", "settings"},
    {"load MD5", "load 8b96297bc95db74738674ce177f501c1", "", "settings"},
    {"load inline", "load inline image=" + counter_as_text(), "", "settings"},
    {"load image", "load inline image=" + counter_as_text(), "load inline", "settings"},
    {"load BASE64", "load inline image=" + counter_as_text(), "load inline image=AAAA", "settings"},
    {"load as", "load duel as=boxing", "load duel", "modes"},
    {"load KEY", "load duel seed=1 difficulty=1", "load duel seed=1 mode=0", "settings"},
    {"load VALUE", "load duel seed=1", "load duel seed=2", "settings"},
    {"settings", "settings", "stats"},
    {"set", "set difficulty=1\nact NOOP", "act NOOP", "look ram"},
    {"set mode", "set mode=2\nreset", "reset", "look ram"},
    {"set difficulty", "set difficulty=1\nact NOOP", "act NOOP", "look ram"},
    {"set N", "set difficulty=1", "set difficulty=2", "difficulties"},
    {"modes", "modes", "load beamfall\nmodes"},
    {"difficulties", "difficulties", "load beamfall\ndifficulties"},
    {"actions", "actions", "load beamfall\nactions"},
    {"observe", "observe frame", "", "act NOOP"},
    {"observe FIELD", "observe frame", "observe lives", "act NOOP"},
    {"observe ENCODING", "observe ram:hex", "observe ram:base64", "act NOOP"},
    {"observe none", "observe none", "", "act NOOP"},
    {"look", "observe frame\nact NOOP\nlook", "observe frame\nlook"},
    {"look FIELD", "look frame", "look lives"},
    {"look ENCODING", "look ram:hex", "look ram:base64"},
    {"act", "act NOOP", "", "look frame"},
    {"act A", "act RIGHT", "act LEFT"},
    {"act STRENGTH", "load beamfall as=breakout\nact RIGHT@0.5*20", "load beamfall as=breakout\nact RIGHT*20",
     "save a\nexport a"},
    {"act B", "act NOOP/RIGHT", "act NOOP", "look reward_b"},
    {"act TIMES", "act RIGHT*3", "act RIGHT"},
    {"reset", "act NOOP\nreset", "act NOOP", "look episode_frame"},
    {"reset seed", kOtherSticky + "\nreset seed=9", kOtherSticky + "\nreset", kAlternating},
    {"reset N", kOtherSticky + "\nreset seed=9", kOtherSticky + "\nreset seed=10", kAlternating},
    {"peek", "peek 0", "poke 0 12\npeek 0"},
    {"peek INDEX", "peek 0", "peek 40"},
    {"peek COUNT", "peek 0 2", "peek 0"},
    {"poke", "poke 40 12", "", "look ram"},
    {"poke INDEX", "poke 40 12", "poke 41 12", "look ram"},
    {"poke HEX", "poke 40 12", "poke 40 1213", "look ram"},
    {"save", "save a", "", "restore a"},
    {"save NAME", "save a", "save b", "restore a"},
    {"save random", kSticky + "\nsave a random=1", kSticky + "\nsave a", kAfterSave},
    {"save 1", kSticky + "\nsave a random=1", kSticky + "\nsave a random=0", kAfterSave},
    {"restore", "save a\nact NOOP\nrestore a", "save a\nact NOOP", "look frame"},
    {"restore NAME", "save a\nact NOOP\nsave b\nrestore a", "save a\nact NOOP\nsave b\nrestore b",
     "look frame"},
    {"drop", "save a\ndrop a", "save a", "states"},
    {"drop NAME", "save a\nsave b\ndrop a", "save a\nsave b\ndrop b", "states"},
    {"drop all", "save a\nsave b\ndrop all", "save a\nsave b\ndrop b", "states"},
    {"states", "save a\nstates", "save b\nstates"},
    {"export", "save a\nexport a", "act NOOP\nsave a\nexport a"},
    {"export NAME", "save a\nact NOOP\nsave b\nexport a", "save a\nact NOOP\nsave b\nexport b"},
    {"import", "import a " + state_as_text(), "save a", "restore a\nlook ram"},
    {"import NAME", "import a " + state_as_text(), "import b " + state_as_text(), "states"},
    {"import BASE64", "import a " + state_as_text(), "import a AAAA", "restore a"},
    {"branch", "save a\nbranch a RIGHT", "save a\nbranch a NOOP"},
    {"branch NAME", "save a\npoke 17 01\nact NOOP\nsave b\nbranch a RIGHT",
     "save a\npoke 17 01\nact NOOP\nsave b\nbranch b RIGHT"},
    {"branch keep", "save a\nbranch a keep=x RIGHT", "save a\nbranch a RIGHT", "restore x0"},
    {"branch PREFIX", "save a\nbranch a keep=x RIGHT", "save a\nbranch a keep=y RIGHT", "restore x0"},
    {"branch ACTION", "save a\nbranch a RIGHT,RIGHT", "save a\nbranch a RIGHT"},
    {"open", "open 2", "", "step RIGHT"},
    {"open N", "open 2", "open 3", "step RIGHT"},
    {"open autoreset", kEnds + "\nopen 1 autoreset=disabled", kEnds + "\nopen 1", kThreeSteps},
    {"open next-step", kEnds + "\nopen 1 autoreset=next-step", kEnds + "\nopen 1 autoreset=disabled",
     kThreeSteps},
    {"open same-step", kEnds + "\nopen 1 autoreset=same-step", kEnds + "\nopen 1 autoreset=next-step",
     kThreeSteps},
    {"open disabled", kEnds + "\nopen 1 autoreset=disabled", kEnds + "\nopen 1 autoreset=same-step",
     kThreeSteps},
    {"open steps", kFrames + "open 1 steps=frames", kFrames + "open 1", "step NOOP"},
    {"open acts", kFrames + "open 1 steps=acts", kFrames + "open 1 steps=frames", "step NOOP"},
    {"open frames", kFrames + "open 1 steps=frames", kFrames + "open 1 steps=acts", "step NOOP"},
    {"open start", kFrames + kStart + "baselines", kFrames + "open 1 steps=frames", "step NOOP"},
    {"open fire-noops", kFrames + kStart + "fire-noops", kFrames + kStart + "noops", "step NOOP"},
    {"open noops-fire", kFrames + kStart + "noops-fire", kFrames + kStart + "fire-noops", "step NOOP"},
    {"open baselines", kFrames + kStart + "baselines", kFrames + kStart + "noops-fire", "step NOOP"},
    {"open noops", kFrames + kStart + "noops", kFrames + kStart + "baselines", "step NOOP"},
    {"open lives", kLongSteps + kLives + "told", kLongSteps + "open 1 steps=frames", "step FIRE"},
    {"open ignored", kLongSteps + kLives + "ignored", kLongSteps + kLives + "told", "step FIRE"},
    {"open told", kLongSteps + kLives + "told", kLongSteps + kLives + "ignored", "step FIRE"},
    {"open end", kLongSteps + kLives + "end", kLongSteps + kLives + "restart", "step FIRE\nstep FIRE"},
    {"open restart", kLongSteps + kLives + "restart", kLongSteps + kLives + "told", "step FIRE\nstep FIRE"},
    {"open stack", kStacked + "stack=repeats", kStacked, "restart"},
    {"open zeros", kStacked + "stack=zeros", kStacked + "stack=repeats", "restart"},
    {"open repeats", kStacked + "stack=repeats", kStacked + "stack=zeros", "restart"},
    {"open pool", kStacked + "pool=0", kStacked, "step FIRE\nstep RIGHT"},
    {"open 0", kStacked + "pool=0", kStacked + "pool=1", "step FIRE\nstep RIGHT"},
    {"open 1", kStacked + "pool=1", kStacked + "pool=0", "step FIRE\nstep RIGHT"},
    {"step", kOpen + "\nstep NOOP", kOpen, "step NOOP"},
    {"step ACTION", "open 2\nstep RIGHT NOOP", "open 2\nstep NOOP RIGHT"},
    {"restart", kOpen + "\nrestart", kOpen, "step NOOP"},
    {"restart MASK", kOpen + "\nrestart 10", kOpen + "\nrestart 01", "step NOOP"},
    {"restart seed", kManySticky + "restart seed=9", kManySticky + "restart", "step NOOP\nstep RIGHT"},
    {"restart N", kManySticky + "restart seed=9", kManySticky + "restart seed=30", "step NOOP\nstep RIGHT"},
    {"close", "open 2\nclose", "open 2", "stats"},
    {"record", "", "record gif a", "record gif b"},
    {"record png", "record png a", "record gif a"},
    {"record gif", "record gif a", "record y4m a"},
    {"record y4m", "record y4m a", "record gif a"},
    {"record wav", "load duel sound=1\nrecord wav a", "load duel sound=1\nrecord gif a"},
    {"record NAME", "record gif a", "record gif b"},
    {"record machine", kUneven + "record png a machine=1", kUneven + "record png a", kFourSteps},
    {"record N", kUneven + "record png a machine=1", kUneven + "record png a machine=0", kFourSteps},
    {"record stop", "record gif a\nact NOOP*4\nrecord stop", "record gif a\nact NOOP*4", "record gif b"},
    {"stats", "stats", "act NOOP\nstats"},
    {"quit", "quit", "stats"},
};

// `load` with a setting, and with another value of it.
const Cases kSettings = {
    {"preset", kLoad + " preset=dqn2015", kLoad + " preset=none", "observe frames\nact NOOP"},
    {"seed", "load duel seed=8 sticky=0.5", "load duel seed=9 sticky=0.5", kAlternating},
    {"system_seed", kLoad + " system_seed=1", kLoad + " system_seed=2", "look ram"},
    {"frame_skip", kLoad + " frame_skip=2", kLoad + " frame_skip=1", "observe frames\nact NOOP"},
    {"sticky", "load duel seed=8 sticky=0.5", "load duel seed=8 sticky=0", kAlternating},
    {"mode", kLoad + " mode=2", kLoad + " mode=0", "look ram"},
    {"difficulty", kLoad + " difficulty=1", kLoad + " difficulty=0", "act NOOP\nlook ram"},
    {"max_episode_frames", kLoad + " max_episode_frames=2", kLoad + " max_episode_frames=0", "act NOOP*3"},
    {"life_loss_ends", kLoad + " life_loss_ends=1", kLoad + " life_loss_ends=0", "poke 18 01\nact NOOP"},
    {"noop_max", kLoad + " noop_max=30", kLoad + " noop_max=0", "look episode_frame"},
    {"autoreset", kLoad + " max_episode_frames=2 autoreset=1", kLoad + " max_episode_frames=2 autoreset=0",
     "observe episode_frame\nact NOOP*2\nact NOOP"},
    {"action_set", kLoad + " action_set=full", kLoad + " action_set=minimal", "act UP"},
    {"reward_min", kLoad + " reward_min=1", kLoad + " reward_min=0", "act NOOP"},
    {"reward_max", kLoad + " reward_max=1", kLoad + " reward_max=2", "observe reward_b\nact NOOP/RIGHT"},
    {"rules", kTetris + " rules=fixed", kTetris + " rules=ale-0.12",
     "poke 113 9999\nact NOOP\npoke 113 0000\nact NOOP"},
    {"color_averaging", "load beamfall seed=7 color_averaging=1", "load beamfall seed=7 color_averaging=0",
     "act FIRE*30\nlook screen"},
    {"sound", kLoad + " sound=1", kLoad + " sound=0", "act NOOP*2\nlook audio"},
};

// What a field says in a conversation in which everything happens, over both television standards.
std::string values_of_field(const std::string& field) {
  std::string values;
  const std::string key = field.substr(0, field.find(':'));
  for (const std::string game : {"duel", "duel_pal"}) {
    LineClient client(duel_service());
    client.ask("load " + game + " seed=7 sticky=0 frame_skip=2 sound=1 max_episode_frames=40 reward_max=1");
    client.ask("observe " + field);
    for (const std::string request :
         {"act NOOP", "act RIGHT*3", "act NOOP/RIGHT", "poke 18 02", "act RIGHT/RIGHT", "reset", "poke 17 01",
          "act LEFT*4", "reset", "act UP*30"})
      (values += value(client.ask(request), key)) += ' ';
  }
  LineClient client(duel_service());
  client.ask("load beamfall seed=7 sticky=0 frame_skip=900 sound=1");
  client.ask("observe " + field);
  client.ask("open 1 steps=frames lives=told");
  return values + value(client.ask("step FIRE"), key, 1);
}

bool is_constant(const std::string& values) {
  std::vector<std::string_view> words;
  split(values, words);
  std::erase(words, "(none)");
  return std::ranges::adjacent_find(words, std::not_equal_to{}) == words.end();
}

// No two of them say the same, and none says the same always.
void check_told_apart(const std::vector<std::string>& fields) {
  std::map<std::string, std::string> seen;
  for (const std::string& field : fields) {
    const std::string values = values_of_field(field);
    INFO(field << " says " << values.substr(0, 200));
    CHECK_FALSE(is_constant(values));
    const auto [place, is_new] = seen.emplace(values, field);
    INFO("as does " << place->second);
    CHECK(is_new);
  }
}

// The keys of a reply, with what they say.
std::map<std::string, std::string> pairs_of(const std::string& reply) {
  std::map<std::string, std::string> pairs;
  std::vector<std::string_view> words;
  split(reply, words);
  for (const std::string_view word : words) {
    if (word.find('=') != std::string_view::npos) {
      const auto [key, told] = key_value(word);
      pairs.emplace(key, told);
    }
  }
  return pairs;
}

LineService other_service() {
  LineLimits limits;
  for (std::size_t* number : {&limits.line, &limits.reply}) *number /= 2;
  for (int* number : {&limits.machines, &limits.states}) *number /= 2;
  limits.request_frames /= 2;
  limits.idle_seconds = 1;
  LineService service = test::line_service(limits);
  service.version = "other";
  service.recorder = std::make_shared<Recorder>("somewhere");
  service.threads = 2;
  service.admission = [](std::string_view token) { return token == kToken; };
  return service;
}

}  // namespace

TEST_CASE("Each setting makes a difference") {
  check_complete(kSettings, names_of(setting_rows()));
  for (const Case& one : kSettings) check_difference(duel_service(), one, "");
}

TEST_CASE("Each preset sets what the table says") {
  LineClient client;
  const auto without = pairs_of(client.ask("load beamfall seed=7"));
  for (const PresetRow& preset : preset_rows()) {
    const std::string name(preset.name), words(preset.words);
    auto written = pairs_of(client.ask("load beamfall seed=7 " + words));
    CHECK(written != without);
    written["preset"] = name;
    CHECK(pairs_of(client.ask("load beamfall seed=7 preset=" + name)) == written);
  }
}

TEST_CASE("Each field tells something that no other tells") {
  std::vector<std::string> fields;
  for (const FieldRow& row : field_rows()) {
    std::string name(row.name);
    if (const std::size_t size = name.find("WxHxN"); size != name.npos) name.replace(size, 5, "40x30x2");
    fields.push_back(name + (row.number ? "" : ":hex"));
  }
  check_told_apart(fields);
}

TEST_CASE("Each encoding writes in a way of its own") {
  std::vector<std::string> fields;
  for (const EncodingRow& row : encodings()) fields.push_back("screen:" + std::string(row.name));
  check_told_apart(fields);
}

// What is the same in all sessions is named; a key that comes later has to differ, or be named too.
TEST_CASE("Each key of a reply tells something") {
  LineClient one(duel_service()), other(other_service());
  other.ask("hello");
  const auto compare = [&](const std::string& request, const std::string& request_of_other,
                           const std::set<std::string>& constant = {}) {
    const auto first = pairs_of(one.ask(request)), second = pairs_of(other.ask(request_of_other));
    CHECK_FALSE(first.empty());
    for (const auto& [key, told] : first) {
      INFO(request << ": " << key << "=" << told);
      CHECK((constant.contains(key) || !second.contains(key) || second.at(key) != told));
    }
  };
  compare("hello", "hello", {"protocol", "encodings", "presets"});
  other.ask("hello token=" + kToken);
  compare("games all", "games");
  compare("games skiing", "games beamfall", {"rule", "modes", "two_player_modes"});
  compare("games pong", "games skiing", {"here", "rule"});
  compare(
      "load duel_pal preset=dqn2015 rules=fixed seed=7 system_seed=1 frame_skip=2-4 mode=2 difficulty=3 "
      "max_episode_frames=9 "
      "life_loss_ends=1 noop_max=3 reward_min=-7 reward_max=7 autoreset=1 color_averaging=1 sound=1",
      "load inline seed=8 image=" + counter_as_text(1), {"width"});
  other.ask("load beamfall as=pong");
  compare("modes", "modes", {"default"});
  other.ask("load beamfall");
  compare("difficulties", "difficulties", {"default"});
  other.ask("load beamfall as=skiing action_set=full");
  compare("actions", "actions");
}

TEST_CASE("Each other name of a command is as good as the command") {
  for (const Alias& alias : aliases()) {
    const std::string name(alias.name), command(alias.command);
    CHECK(last_reply(duel_service(), name) == last_reply(duel_service(), command));
    CHECK(last_reply(duel_service(), "help " + name) == last_reply(duel_service(), "help " + command));
  }
}

TEST_CASE("Each error code is told") {
  const std::map<std::string_view, std::string> told = {
      {"bad-line", "\n"},
      {"line-too-long", std::string((1 << 20) + 1, 'x') + "\n"},
      {"half-line", "act"},
      {"unknown-command", "atc\n"},
      {"bad-arguments", "observe nothing\n"},
      {"bad-value", "games\nload duel sticky=2\n"},
      {"bad-action", kLoad + "\nact HOP\n"},
      {"unknown-game", "load nothing\n"},
      {"bad-image", "load inline image=A\n"},
      {"no-game", "act NOOP\n"},
      {"no-machines", kLoad + "\nstep NOOP\n"},
      {"no-state", kLoad + "\nrestore a\n"},
      {"bad-state", kLoad + "\nimport a AAAA\n"},
      {"recording", kLoad + "\nrecord gif a\n"},
      {"limit", kLoad + "\nopen 1000\n"},
      {"unauthorized", "hello token=guess\n"},
  };
  // Those of the server about a session as a whole (tests/server/test_sessions.py), and what never should be.
  const std::set<std::string_view> others = {"busy", "idle", "stopping", "internal"};
  std::set<std::string_view> all = others;
  for (const auto& [name, conversation] : told) {
    INFO(name);
    LineService service = duel_service();
    if (name == "unauthorized") service.admission = [](std::string_view) { return false; };
    LineClient client(service);
    std::string replies = client.say(conversation);
    replies += client.close();
    REQUIRE(replies.ends_with('\n'));
    replies.pop_back();
    CHECK(code(replies.substr(replies.rfind('\n') + 1)) == name);
    all.insert(name);
  }
  const auto names = names_of(codes());
  CHECK(all == std::set(names.begin(), names.end()));
}

TEST_CASE("Each command and each word of its arguments makes a difference") {
  std::vector<Case> all = kFirst;
  all.insert(all.end(), kPlaying.begin(), kPlaying.end());
  check_complete(all, commands_and_words());
  for (const Case& one : kFirst) {
    LineService guarded = duel_service();
    guarded.admission = [](std::string_view token) { return token == kToken; };
    check_difference(guarded, one, "");
  }
  for (const Case& one : kPlaying) {
    const Room room;  // a recording's file is there only once
    check_difference(room.service, one, kLoad);
  }
}
