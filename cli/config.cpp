#include "cli/config.hpp"

#include <charconv>
#include <iomanip>
#include <iostream>
#include <memory>

#include "cli/serve_options.hpp"

namespace racebeam {
namespace {

constexpr auto kFooter =
    R"(Takes what racebeam serve takes, and serves nothing: it prints each setting with its value and where that
comes from, as a TOML file that racebeam serve --config reads. The command line wins over the environment
(RACEBEAM_MAX_STATES for --max-states), that over the file (max_states), that over the default.)";

constexpr int kColumn = 44;  // of the comments

bool is_number(const std::string& text) {
  double number = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && rest == text.data() + text.size() &&
         (text == "0" || text[0] != '0' || text.starts_with("0."));
}

std::string quoted(const std::string& text) {
  std::string all = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') all += '\\';
    all += c;
  }
  return all + '"';
}

std::string as_toml(const std::string& text) {
  return is_number(text) || text == "true" || text == "false" ? text : quoted(text);
}

std::string as_toml(const Setting& setting) {
  if (setting.option->get_items_expected_max() <= 1) return as_toml(setting.values.back());
  std::string list;
  for (const std::string& value : setting.values) list += (list.empty() ? "" : ", ") + quoted(value);
  return "[" + list + "]";
}

void print(const Setting& setting) {
  const std::string key = key_of(*setting.option);
  const std::string line = setting.values.empty() ? "# " + key + " =" : key + " = " + as_toml(setting);
  std::cout << std::left << std::setw(kColumn) << line << "  # " << describe(setting.source) << "\n";
}

}  // namespace

void add_config(CLI::App& app) {
  CLI::App* command = app.add_subcommand("config", "Show the settings of racebeam serve, and their sources");
  command->footer(kFooter);
  const auto options = std::make_shared<ServeOptions>();
  add_serve_options(*command, *options);
  command->callback([options, command] {
    for (const Setting& setting : complete(*command)) print(setting);
  });
}

}  // namespace racebeam
