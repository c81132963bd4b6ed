// The tables of protocol/PROTOCOL.md equal those of the program.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <string_view>

#include "emulator/tia/registers/register_values.hpp"
#include "environment/settings/play_settings.hpp"
#include "protocol/encoding/encoding.hpp"
#include "protocol/line/commands/command_table.hpp"
#include "protocol/line/field.hpp"
#include "protocol/request_error.hpp"

using namespace racebeam;
using Catch::Matchers::Contains;

namespace {

std::string document(const std::string& path = "/protocol/PROTOCOL.md") {
  std::ifstream file(RACEBEAM_SOURCE_DIR + path);
  return {std::istreambuf_iterator<char>(file), {}};
}

// The rows of the table that begins with `head`.
std::string table(const std::string& head) {
  const std::string text = document();
  const std::size_t begin = text.find(head + "\n|---");
  REQUIRE(begin != std::string::npos);
  const std::size_t first = text.find('\n', begin + head.size() + 1) + 1;
  return text.substr(first, text.find("\n\n", first) + 1 - first);
}

std::string in_table(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '|') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

std::string in_code(std::string_view text) {
  std::string code = "| `";
  (code += text) += "` |";
  return code;
}

std::ptrdiff_t lines(const std::string& text) { return std::ranges::count(text, '\n'); }

}  // namespace

TEST_CASE("The document has each command, with its arguments and its summary, and no other") {
  std::string expected;
  for (const Command& command : commands()) {
    (expected += "| `") += command.name;
    if (!command.arguments.empty()) (expected += ' ') += in_table(command.arguments);
    ((expected += "` | ") += command.summary) += " |\n";
  }
  CHECK(table("| command | what it does |") == expected);
}

TEST_CASE("The document has each setting, preset, field, encoding and error code, and no other") {
  const auto compare = [](const std::string& head, const auto& rows) {
    const std::string found = table(head);
    CHECK(lines(found) == std::ssize(rows));
    for (const auto& row : rows) {
      CHECK_THAT(found, Contains(in_code(row.name)));
    }
  };
  std::vector<SettingRow> settings;
  std::ranges::remove_copy_if(setting_rows(), std::back_inserter(settings), &SettingRow::is_deprecated);
  compare("| setting | values | default | meaning |", settings);
  compare("| preset | sets | source |", preset_rows());
  compare("| field | content | encoding |", field_rows());
  compare("| encoding | form |", encodings());
  compare("| code | meaning |", codes());
  for (const SettingRow& setting : settings) {
    const std::string row = in_code(setting.name) + " " + std::string(setting.accepted) + " |";
    CHECK_THAT(table("| setting | values | default | meaning |"), Contains(row));
    CHECK_THAT(table("| setting | values | default | meaning |"),
               Contains("| " + std::string(setting.summary) + " |\n"));
  }
  for (const FieldRow& field : field_rows()) {
    const std::string row = in_code(field.name) + " " + std::string(field.summary) + " |";
    CHECK_THAT(table("| field | content | encoding |"), Contains(row));
  }
  for (const ErrorRow& code : codes()) {
    const std::string row = in_code(code.name) + " " + std::string(code.meaning) + " |\n";
    CHECK_THAT(table("| code | meaning |"), Contains(row));
  }
  for (const PresetRow& preset : preset_rows())
    CHECK_THAT(table("| preset | sets | source |"), Contains(in_code(preset.words)));
}

TEST_CASE("Documents that count the encodings count all of them") {
  constexpr std::array<std::string_view, 10> kNumbers = {"no",   "one", "two",   "three", "four",
                                                         "five", "six", "seven", "eight", "nine"};
  const std::regex claim("(no|one|two|three|four|five|six|seven|eight|nine)\\sencodings");
  for (const char* const path : {"/README.md", "/CHANGELOG.md", "/protocol/PROTOCOL.md"}) {
    const std::string text = document(path);
    INFO(path);
    for (std::sregex_iterator found(text.begin(), text.end(), claim), end; found != end; ++found)
      CHECK(found->str(1) == kNumbers.at(encodings().size()));
  }
}

TEST_CASE("A code's place in the table is its number") {
  CHECK(name_of(ErrorCode::kBadLine) == "bad-line");
  CHECK(name_of(ErrorCode::kInternal) == "internal");
  CHECK(static_cast<std::size_t>(ErrorCode::kInternal) == codes().size() - 1);
}

TEST_CASE("The document lists the bytes of the field tia in their order") {
  std::string names;
  for (const std::string_view name : kTiaValueNames) (names += names.empty() ? "" : " ") += name;
  CHECK_THAT(std::regex_replace(document(), std::regex("\\s+"), " "), Contains(names));
  const auto rows = field_rows();
  const auto row = std::ranges::find(rows, "tia", &FieldRow::name);
  CHECK(row->summary.starts_with(std::to_string(kTiaValues) + " bytes: "));
}
