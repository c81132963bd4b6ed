// A subcommand and its options. CLI11 parses them. It is headers only, and takes longer to compile than what
// uses it. So only main.cpp, and files beside this one, include it.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace racebeam {

// Options that are wrong, or do not fit together: exit status 2. The sentence names the option.
struct UsageError : std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

// What an option accepts. It sees the text before it is converted, because CLI11's own messages do not say
// what is accepted.
struct Check {
  std::function<std::string(const std::string& text)> refusal;  // a sentence; empty: the text is accepted
  std::string accepted;                                         // for the help text; may be empty
};

Check whole_number(std::int64_t least, std::int64_t most);
Check number(double least, double most, const std::string& accepted = "");
Check one_of(const std::vector<std::string>& words);

// One option, whose properties can be set in a chain.
class Option {
 public:
  explicit Option(CLI::Option& option) : option_(&option) {}

  Option& required(bool is = true);
  Option& excludes(const Option& other);
  Option& check(const Check& check);
  Option& sizes();                              // also accepts 512M or 2G
  Option& one_a_time();                         // a list takes one value each time that the option is given
  Option& shows_default();                      // the help text has the value that the variable has now
  Option& default_text(const std::string& it);  // or this one
  Option& variable(const std::string& name);  // of the environment, which is used if the option is not given
  Option& help(const std::string& text);
  Option& value_name(const std::string& name);
  Option& group(const std::string& name);

 private:
  CLI::Option* option_;
};

class Subcommand {
 public:
  explicit Subcommand(CLI::App& app) : app_(&app) {}

  Subcommand add_subcommand(const std::string& name, const std::string& about, const std::string& footer);

  // `name` is "--name", or "NAME" for an argument without a name. The variable must outlive the parsing.
  // Value is a text, a number, an optional of one, or a list of texts.
  template <typename Value>
  Option option(const std::string& name, Value& value, const std::string& help);

  Option flag(const std::string& name, bool& value, const std::string& help);

  // An option without a variable: `set` gets its text, if it is not null.
  Option option(const std::string& name, const std::function<void(const std::string&)>& set,
                const std::string& help);

  // An option whose values have names.
  template <typename Value>
  Option choice(const std::string& name, Value& value, const std::map<std::string, Value>& choices,
                const std::string& default_value, const std::string& help);

  Option find(const std::string& name);

  // What the command does, after its options were parsed.
  void runs(const std::function<void()>& run);
  void exits_with(const std::function<int()>& run);  // the exit status of the program

  void takes_all_words();                  // the command parses its words itself
  std::vector<std::string> words() const;  // that were not parsed

  CLI::App& app() { return *app_; }

 private:
  CLI::App* app_;
};

template <typename Value>
Option Subcommand::choice(const std::string& name, Value& value, const std::map<std::string, Value>& choices,
                          const std::string& default_value, const std::string& help) {
  std::vector<std::string> names;
  for (const auto& [word, ignored] : choices) names.push_back(word);
  const std::function<void(const std::string&)> set = [&value, choices](const std::string& word) {
    value = choices.at(word);
  };
  return option(name, set, help).check(one_of(names)).default_text(default_value).value_name("NAME");
}

}  // namespace racebeam
