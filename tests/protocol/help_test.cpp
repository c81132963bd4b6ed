// help, suggestions and comments, for users who type.
#include "protocol/line/commands/help.hpp"

#include <catch2/catch.hpp>
#include <map>
#include <regex>

#include "environment/settings/play_settings.hpp"
#include "protocol/encoding/encoding.hpp"
#include "protocol/line/commands/command_table.hpp"
#include "protocol/line/field.hpp"
#include "tests/protocol/duel.hpp"

using namespace racebeam;
using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;
using Catch::Matchers::StartsWith;
using test::code;
using test::kLoad;
using test::LineClient;
using test::value;

namespace {

std::string plain(std::string_view text) {
  std::string plain(text);
  std::erase(plain, '`');
  return plain;
}

// help explains these names as topics or commands, where they are also words of arguments.
bool is_topic_or_command(std::string_view name) {
  const auto named = [name](const auto& row) { return row.name == name; };
  return std::ranges::any_of(help_topics(), named) || std::ranges::any_of(commands(), named);
}

// All names that help knows, with a part of each help text.
std::multimap<std::string, std::string> all_names() {
  std::multimap<std::string, std::string> names;
  const auto add = [&names](std::string_view name, std::string_view text) {
    names.emplace(name, plain(text));
  };
  for (const Command& row : commands()) add(row.name, row.summary);
  for (const SettingRow& row : setting_rows()) {
    add(row.name, row.summary);
    add(row.name, row.accepted);
    add("settings", row.summary);
  }
  for (const PresetRow& row : preset_rows()) {
    add(row.name, row.words);
    add("presets", row.words);
  }
  for (const FieldRow& row : field_rows()) {
    add(row.name, row.summary);
    add("fields", row.summary);
  }
  for (const EncodingRow& row : encodings()) {
    add(row.name, row.summary);
    add("encodings", row.summary);
  }
  for (const ErrorRow& row : codes()) {
    add(row.name, row.meaning);
    add("errors", row.meaning);
  }
  const std::regex word("[a-z0-9_-]+");
  for (const Command& row : commands()) {
    const std::string arguments(row.arguments);
    for (std::sregex_iterator found(arguments.begin(), arguments.end(), word), end; found != end; ++found)
      if (!is_topic_or_command(found->str())) add(found->str(), row.arguments);
  }
  add("grey84x4", "a stack of N screens");
  add("rgb100x50x4", "a stack of N screens, W x H, in colour");
  for (const Command& row : commands()) {
    // NAME of a session, or of a folder
    const bool is_other = row.name == "share" || row.name == "watch" || row.name == "log";
    if (row.arguments.starts_with("NAME") && !is_other) add("states", row.summary);
  }
  return names;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

std::string without_blanks(std::string text) {
  std::erase_if(text, [](char c) { return c == ' ' || c == '\n' || c == ';'; });
  return text;
}

}  // namespace

TEST_CASE("help explains each name of each table, on one line") {
  LineClient client;
  for (const auto& [name, text] : all_names()) {
    INFO(name);
    if (name == "settings" && text == "show the settings in effect")
      continue;  // a topic is preferred to the command
    const std::string reply = client.say("help " + name + "\n");
    CHECK_THAT(reply, StartsWith("ok ") && Contains(text));
    CHECK(std::ranges::count(reply, '\n') == 1);
    CHECK_THAT(reply, !Contains("`") && !Contains(":;") && !Contains("::"));
  }
}

TEST_CASE("help explains each value of a key that has a list of them") {
  LineClient client;
  CHECK_THAT(client.ask("help start"), Contains("; start=noops-fire: as in EnvPool: the no-ops, then FIRE") &&
                                           Contains("; start=noops: only the no-ops"));
  CHECK_THAT(client.ask("help reported"),
             Contains("; life_loss=reported: the act or step that loses a life is terminated") &&
                 !Contains("life_loss=end:"));
}

TEST_CASE("help says what it has help on") {
  LineClient client;
  const std::string reply = client.ask("help");
  for (const HelpTopic& topic : help_topics())
    CHECK_THAT(reply, Contains(std::string(" ").append(topic.name)));
  CHECK_THAT(client.ask("help stiky"),
             StartsWith("error bad-arguments unknown word 'stiky'; did you mean sticky?"));
  CHECK_THAT(client.ask("help xyzzy"), EndsWith("; help without a word lists all"));
}

TEST_CASE("For a person help is folded to the width of the terminal, and says the same") {
  LineClient program;
  for (const int columns : {40, 80, 132}) {
    LineClient person;
    person.session.set_columns(columns);
    for (const auto& [name, text] : all_names()) {
      const std::string request = "help " + name, reply = person.ask(request);
      CHECK(without_blanks(reply) == without_blanks(program.ask(request)));
      for (const std::string& line : lines_of(reply)) {
        INFO(line);
        const bool one_word = line.find(' ', line.find_first_not_of(' ')) == std::string::npos;
        CHECK((line.size() <= static_cast<std::size_t>(columns) || one_word));
      }
    }
    CHECK(lines_of(person.ask("help settings")).size() > setting_rows().size());
    CHECK(lines_of(person.ask(kLoad)).size() == 1);
  }
}

TEST_CASE("Similar names are suggested, for every kind of name") {
  LineClient client;
  client.say(kLoad + "\nsave start\nopen 2\n");
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"atc RIGHT", "; did you mean act or watch? Accepted: hello"},
      {"LOAD beamfall", "; did you mean load?"},
      {"load beamfal", "; did you mean beamfall?"},
      {"load beamfall as=pogn", "; did you mean pong?"},
      {"load beamfall stiky=0", "; did you mean sticky? Accepted: preset"},
      {"load inline imgae=AAAA", "; did you mean image? Accepted: preset"},
      {"load beamfall is=pong", "; did you mean as? Accepted: preset"},
      {"set mod=1",
       "'mod' cannot be set while a game runs; did you mean mode? Accepted: mode and difficulty"},
      {"set dificulty=1", "; did you mean difficulty? Accepted:"},
      {"load beamfall preset=dqn", "; did you mean dqn2015? It takes paper2013"},
      {"load beamfall rules=fix", "; did you mean fixed? It takes ale-0.12 or fixed"},
      {"load beamfall action_set=minimum",
       "; did you mean minimal? It takes full, legal, minimal or console"},
      {"observe rewrd", "; did you mean reward"},
      {"observe non", "; did you mean none"},
      {"observe screen:zip", "; did you mean zlib? Accepted: hex"},
      {"act RIHGT", "; did you mean RIGHT? beamfall takes 0=NOOP"},
      {"act fier", "; did you mean FIRE?"},
      {"act NOOP/lefft", "; did you mean LEFT"},
      {"branch start UP,DWON", "; did you mean DOWN"},
      {"step FIER", "; did you mean FIRE?"},
      {"restore strat", "; did you mean start? Accepted: start"},
      {"open 2 autoreset=samestep", "; did you mean same-step? It takes next-step"},
      {"help setings", "; did you mean settings"},
      {"record giff a", " did you mean gif?"}};
  for (const auto& [request, question] : cases) {
    INFO(request);
    CHECK_THAT(client.ask(request), StartsWith("error ") && Contains(question));
  }
}

TEST_CASE("A name without similar ones gets the list of names") {
  LineClient client;
  client.ask(kLoad);
  CHECK_THAT(client.ask("xyzzy"), Contains("unknown command 'xyzzy'; accepted: hello help"));
  CHECK_THAT(client.ask("load plughplugh"), EndsWith("; games lists the available games"));
  CHECK(client.ask("restore a") == "error no-state unknown state 'a'; accepted: none");
}

TEST_CASE("Lines that begin with # are comments, and have no reply") {
  LineClient client;
  CHECK(client.say("# a script\n  # indented\n#\n" + kLoad +
                   "\n# gr\xC3\xBC\xC3\x9F\r\nobserve frame\nact NOOP\n") ==
        client.say(kLoad + "\nobserve frame\nact NOOP\n"));
  CHECK(value(client.ask("stats"), "requests") == "7");
  CHECK(value(client.ask("stats"), "errors") == "0");
  CHECK(code(client.ask("act # NOOP")) == "bad-action");
  std::string comments;
  for (int line = 0; line < 2000; ++line) comments += "# and on\n";
  CHECK(client.say(comments).empty());
  CHECK(client.say(comments + "act NOOP\n" + comments + "act NOOP\n") == "ok frame=2\nok frame=3\n");
  CHECK(client.say("# the end").empty());
  CHECK(client.close().empty());
}
