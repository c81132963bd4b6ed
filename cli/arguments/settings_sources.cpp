#include "cli/arguments/settings_sources.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <map>
#include <sstream>
#include <system_error>

#include "cli/arguments/subcommand.hpp"
#include "games/files/toml.hpp"
#include "system/input_file.hpp"
#include "system/words.hpp"

namespace racebeam {
namespace {

using Values = std::vector<std::string>;
constexpr auto kConfig = "--config";

struct FromFile {
  std::string name;
  std::map<std::string, Values> values;  // by key
};

std::string key_of(const CLI::Option& option) {
  std::string key = option.get_lnames().front();
  std::ranges::replace(key, '-', '_');
  return key;
}

std::string variable_of(const CLI::Option& option) {
  std::string name = "RACEBEAM_" + key_of(option);
  std::ranges::transform(name, name.begin(), [](char c) { return c >= 'a' && c <= 'z' ? char(c - 32) : c; });
  return name;
}

bool is_list(const CLI::Option& option) { return option.get_items_expected_max() > 1; }
bool is_flag(const CLI::Option& option) { return option.get_items_expected_max() == 0; }

// The options that are settings, without those that act at once, such as --help, and without positional ones.
std::vector<CLI::Option*> settings_of(CLI::App& command) {
  auto options = command.get_options();
  std::erase_if(options, [&](const CLI::Option* option) {
    return option == command.get_help_ptr() || option->check_name(kConfig) || option->get_positional();
  });
  return options;
}

std::string text_of(const toml::node& node, const std::string& where) {
  if (const auto* text = node.as_string()) return text->get();
  if (const auto* number = node.as_integer()) return std::to_string(number->get());
  if (const auto* truth = node.as_boolean()) return truth->get() ? "true" : "false";
  if (const auto* real = node.as_floating_point()) {
    std::array<char, 64> digits;  // the fewest that give the same number again
    return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), real->get()).ptr};
  }
  throw UsageError(where + ": must be a text, a number, true or false, or a list of them");
}

Values values_of(const toml::node& node, const std::string& where) {
  Values values;
  if (const auto* array = node.as_array()) {
    for (const toml::node& element : *array) values.push_back(text_of(element, where));
  } else {
    values.push_back(text_of(node, where));
  }
  return values;
}

[[noreturn]] void refuse_key(const std::string& path, const std::string& key,
                             const std::vector<CLI::Option*>& options) {
  std::vector<std::string> keys;
  for (const CLI::Option* option : options) keys.push_back(key_of(*option));
  const std::vector<std::string_view> names(keys.begin(), keys.end());
  throw UsageError(path + ": unknown setting '" + key + "';" +
                   advice(key, names, "accepted: " + CLI::detail::join(keys, ", ")));
}

FromFile read_file(const std::string& path, const std::vector<CLI::Option*>& options) {
  FromFile file{path, {}};
  if (path.empty()) return file;
  constexpr std::size_t kLargestFile = 1 << 20;
  toml::table table;
  try {
    table = toml::parse(read_input_file("cannot read", path, kLargestFile), path);
  } catch (const InputFileError& error) {
    throw UsageError("--config: " + std::string(error.what()));
  } catch (const toml::parse_error& error) {
    const auto line = error.source().begin.line;
    throw UsageError(path + (line > 0 ? ": line " + std::to_string(line) : "") + ": " +
                     std::string(error.description()));
  }
  for (const auto& [key, node] : table) {
    const std::string name(key.str());
    const auto is_named = [&name](const CLI::Option* option) { return key_of(*option) == name; };
    if (std::ranges::none_of(options, is_named)) refuse_key(path, name, options);
    file.values[name] = values_of(node, path + ": " + name);
  }
  return file;
}

// The words of a list are separated by blanks.
Values in_environment(const CLI::Option& option) {
  const char* const text = std::getenv(variable_of(option).c_str());
  if (text == nullptr || *text == '\0') return {};
  if (!is_list(option)) return {text};
  std::istringstream words(text);
  return {std::istream_iterator<std::string>(words), {}};
}

void give(CLI::Option& option, const Values& values, const std::string& where) {
  if (values.size() > 1 && !is_list(option)) throw UsageError(where + ": must be one value");
  for (const std::string& value : values) {
    const bool truth = value == "true" || value == "false" || value == "1" || value == "0";
    if (is_flag(option) && !truth) throw UsageError(where + ": must be true or false, not '" + value + "'");
    option.add_result(value);
  }
  try {
    option.run_callback();
  } catch (const CLI::ParseError& error) {
    throw UsageError(where + ": " + error.what());
  }
}

Setting complete(CLI::Option& option, const FromFile& file) {
  const auto setting = [&option](Source source, const Values& values) {
    return Setting{key_of(option), is_list(option), source, values};
  };
  if (option.count() > 0) return setting(Source::kCommandLine, option.results());
  if (const Values values = in_environment(option); !values.empty()) {
    give(option, values, variable_of(option));
    return setting(Source::kEnvironment, values);
  }
  if (const auto found = file.values.find(key_of(option)); found != file.values.end()) {
    if (!found->second.empty()) give(option, found->second, file.name + ": " + found->first);
    return setting(Source::kFile, found->second);
  }
  const std::string default_text = is_flag(option) ? "false" : option.get_default_str();
  return setting(Source::kDefault, default_text.empty() ? Values{} : Values{default_text});
}

// The value of the option --config, or of its environment variable.
std::string config_file(const CLI::Option& option) {
  if (option.count() > 0) return option.results().back();
  const char* const path = std::getenv(variable_of(option).c_str());
  return path == nullptr ? "" : path;
}

}  // namespace

std::string describe(Source source) {
  switch (source) {
    case Source::kCommandLine: return "command line";
    case Source::kEnvironment: return "environment";
    case Source::kFile: return "file";
    case Source::kDefault: break;
  }
  return "default";
}

std::string Setting::name() const {
  std::string name = "--" + key;
  std::ranges::replace(name, '_', '-');
  return name;
}

bool is_default(const std::vector<Setting>& settings, const std::string& key) {
  return std::ranges::any_of(settings, [&](const Setting& setting) {
    return setting.key == key && setting.source == Source::kDefault;
  });
}

std::vector<Setting> complete(Subcommand command) {
  const auto options = settings_of(command.app());
  const FromFile file = read_file(config_file(*command.app().get_option(kConfig)), options);
  std::vector<Setting> settings;
  for (CLI::Option* option : options) settings.push_back(complete(*option, file));
  return settings;
}

}  // namespace racebeam
