#include "cli/commands/config.hpp"

#include <algorithm>
#include <iomanip>
#include <iostream>
#include <memory>
#include <string_view>

#include "cli/commands/serve_options.hpp"

namespace racebeam {
namespace {

constexpr auto kConfigFooter =
    R"(Takes the options of racebeam serve, but does not serve. It prints each setting with its value and its source,
as a TOML file that racebeam serve --config reads. The command line takes precedence over the environment
(RACEBEAM_MAX_STATES for --max-states), the environment over the file (max_states), and the file over the
default.)";

constexpr int kColumn = 44;  // where comments begin

// Whether TOML and this program write the number in the same way. Anything else is quoted.
bool is_number(const std::string& text) {
  constexpr std::size_t kMaxDigits = 15;  // that a double represents exactly
  const auto all_digits = [](std::string_view part) {
    return !part.empty() && std::ranges::all_of(part, [](char c) { return c >= '0' && c <= '9'; });
  };
  const std::size_t point = text.find('.');
  const std::string_view whole = std::string_view(text).substr(0, point);
  if (text.size() > kMaxDigits || !all_digits(whole) || (whole.size() > 1 && whole[0] == '0')) return false;
  return point == std::string::npos || (all_digits(text.substr(point + 1)) && text.back() != '0');
}

// The control characters U+0080 to U+009F, whose second byte equals their number.
bool begins_control_pair(std::string_view text) {
  return text.size() > 1 && text[0] == '\xC2' && (text[1] & 0xE0) == 0x80;
}

std::string quoted(const std::string& text) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string all = "\"";
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text[at] == '"' || text[at] == '\\') all += '\\';
    const bool is_pair = begins_control_pair(std::string_view(text).substr(at));
    const auto byte = static_cast<unsigned char>(text[is_pair ? ++at : at]);
    if (byte < ' ' || byte == 0x7F || is_pair) {
      ((all += "\\u00") += kDigits[byte >> 4]) += kDigits[byte & 15];
    } else {
      all += text[at];
    }
  }
  return all + '"';
}

std::string as_toml(const std::string& text) {
  return is_number(text) || text == "true" || text == "false" ? text : quoted(text);
}

std::string as_toml(const Setting& setting) {
  if (!setting.is_list) return as_toml(setting.values.back());
  std::string list;
  for (const std::string& value : setting.values) list += (list.empty() ? "" : ", ") + quoted(value);
  return "[" + list + "]";
}

void print(const Setting& setting) {
  const std::string& key = setting.key;
  const std::string line = setting.values.empty() ? "# " + key + " =" : key + " = " + as_toml(setting);
  std::cout << std::left << std::setw(kColumn) << line << "  # " << describe(setting.source) << "\n";
}

}  // namespace

void add_config(Subcommand& program) {
  Subcommand command = program.add_subcommand(
      "config", "Show the settings of racebeam serve, and their sources", kConfigFooter);
  const auto options = std::make_shared<ServeOptions>();
  add_serve_options(command, *options);
  command.runs([options, command] {
    for (const Setting& setting : complete(command)) print(setting);
  });
}

}  // namespace racebeam
