// Everything that protocol/PROTOCOL.md offers makes a difference. The tests go over the program's tables.
// Each command, word of a command's arguments, setting, preset, field, encoding and error code needs a case,
// here or in effect_cases.cpp. A server that ignored it would fail that case.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>

#include "environment/settings/play_settings.hpp"
#include "protocol/encoding/encoding.hpp"
#include "protocol/line/commands/command_table.hpp"
#include "protocol/line/field.hpp"
#include "recording/recorder.hpp"
#include "system/named_rows.hpp"
#include "tests/protocol/duel.hpp"
#include "tests/protocol/effect_cases.hpp"

using namespace racebeam;
using test::Case;
using test::Cases;
using test::code;
using test::counter_as_text;
using test::duel_service;
using test::kLoadDuel;
using test::kToken;
using test::LineClient;
using test::value;

namespace {

struct Room {  // where conversations are held, with a script in the place of ffmpeg
  Scratch folder, tools;
  LineService service = duel_service();
  Room() {
    service.recorder = std::make_shared<Recorder>(folder.path(""));
    const std::string script = tools.write("ffmpeg", "#!/bin/sh\nexec cat > /dev/null\n");
    std::filesystem::permissions(script, std::filesystem::perms::owner_all);
    ::setenv("PATH", (tools.path("") + ":" + path).c_str(), 1);
  }
  ~Room() { ::setenv("PATH", path.c_str(), 1); }
  Room(const Room&) = delete;
  Room& operator=(const Room&) = delete;

 private:
  const std::string path = std::getenv("PATH");
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
      if (std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_') {
        word += c;
      } else if (!word.empty()) {
        all.push_back(name + ' ' + std::exchange(word, ""));
      }
    }
  }
  return all;
}

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

// No two fields say the same, and no field says the same always.
void check_told_apart(const std::vector<std::string>& fields) {
  std::map<std::string, std::string> effects;
  for (const std::string& field : fields) {
    const std::string values = values_of_field(field);
    INFO(field << " says " << values.substr(0, 200));
    CHECK_FALSE(is_constant(values));
    const auto [place, is_new] = effects.emplace(values, field);
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
      const auto [key, value] = key_value(word);
      pairs.emplace(key, value);
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
  check_complete(test::cases_of_settings(), names_of(setting_rows()));
  for (const Case& one : test::cases_of_settings()) check_difference(duel_service(), one, "");
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

TEST_CASE("Each encoding writes in its own way") {
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
    for (const auto& [key, value] : first) {
      INFO(request << ": " << key << "=" << value);
      CHECK((constant.contains(key) || !second.contains(key) || second.at(key) != value));
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
      "life_loss=reported noop_max=3 reward_min=-7 reward_max=7 autoreset=1 color_averaging=1 sound=1 "
      "left=paddles right=paddles ystart=40",
      "load inline seed=8 image=" + counter_as_text(1), {"width", "scheme", "life_loss_ends"});
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

TEST_CASE("Each error code is reported") {
  const std::map<std::string_view, std::string> sentences = {
      {"bad-line", "\n"},
      {"line-too-long", std::string((1 << 20) + 1, 'x') + "\n"},
      {"half-line", "act"},
      {"unknown-command", "atc\n"},
      {"bad-arguments", "observe nothing\n"},
      {"bad-value", "games\nload duel sticky=2\n"},
      {"bad-action", kLoadDuel + "\nact HOP\n"},
      {"unknown-game", "load nothing\n"},
      {"bad-image", "load inline image=A\n"},
      {"no-game", "act NOOP\n"},
      {"no-machines", kLoadDuel + "\nstep NOOP\n"},
      {"no-state", kLoadDuel + "\nrestore a\n"},
      {"bad-state", kLoadDuel + "\nimport a AAAA\n"},
      {"recording", kLoadDuel + "\nrecord gif a\n"},
      {"no-log", kLoadDuel + "\nlog stop\n"},
      {"limit", kLoadDuel + "\nopen 1000\n"},
      {"unauthorized", "hello token=guess\n"},
  };
  // The errors of the server about a session as a whole (tests/server/test_sessions.py), and what never
  // should be.
  const std::set<std::string_view> others = {"busy", "idle", "stopping", "internal"};
  std::set<std::string_view> all = others;
  for (const auto& [name, conversation] : sentences) {
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
  const Cases &first = test::cases_without_game(), &playing = test::cases_with_duel();
  Cases all = first;
  all.insert(all.end(), playing.begin(), playing.end());
  check_complete(all, commands_and_words());
  for (const Case& one : first) {
    LineService guarded = duel_service();
    guarded.admission = [](std::string_view token) { return token == kToken; };
    check_difference(guarded, one, "");
  }
  for (const Case& one : playing) {
    const Room room;  // a recording's file is there only once
    check_difference(room.service, one, kLoadDuel);
  }
}
