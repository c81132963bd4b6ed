#include "cli/arguments/subcommand.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <optional>
#include <string_view>

#include "system/words.hpp"

namespace racebeam {
namespace {

constexpr std::uint64_t kMaxBytes = 1ULL << 60;

CLI::Validator validator(const Check& check) { return CLI::Validator(check.refusal, check.accepted); }

// A number of bytes, of KiB (512K, 512KB or 512KiB), and so on.
std::optional<std::uint64_t> size_of(std::string_view text) {
  static constexpr std::string_view kUnits = "kmgtpe";
  const std::size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
  std::string unit = lower_case(text.substr(digits));
  unit.erase(0, unit.find_first_not_of(' '));
  const auto number = parse_number<std::uint64_t>(text.substr(0, digits));
  const std::size_t place = unit.empty() ? std::string_view::npos : kUnits.find(unit.front());
  const std::string_view rest = std::string_view(unit).substr(place == std::string_view::npos ? 0 : 1);
  const bool is_known = rest.empty() || rest == "b" || (rest == "ib" && rest.size() < unit.size());
  const std::size_t shift = place == std::string_view::npos ? 0 : 10 * (place + 1);
  if (!number || !is_known || *number > kMaxBytes >> shift) return std::nullopt;
  return *number << shift;
}

}  // namespace

Check whole_number(std::int64_t least, std::int64_t most) {
  const auto refusal = [least, most](const std::string& text) {
    const auto number = parse_number<std::int64_t>(text);
    const bool is_minus_zero = number == 0 && text.starts_with('-');
    if (number && !is_minus_zero && *number >= least && *number <= most) return std::string{};
    return "'" + text + "' is not a whole number from " + std::to_string(least) + " to " +
           std::to_string(most);
  };
  return {refusal, ""};
}

// CLI::Range accepts "nan".
Check number(double least, double most, const std::string& accepted) {
  const auto refusal = [least, most](const std::string& text) {
    const auto number = parse_number<double>(text);
    if (number && *number >= least && *number <= most) return std::string{};
    std::string sentence = "'" + text + "' is not a number from ";
    append_number(sentence, least);
    append_number(sentence += " to ", most);
    return sentence;
  };
  return {refusal, accepted};
}

Check one_of(const std::vector<std::string>& words) {
  const auto refusal = [words](const std::string& text) {
    const bool is_known = std::ranges::find(words, text) != words.end();
    return is_known ? std::string{} : "unknown value '" + text + "'; accepted: " + join(words, ", ", " and ");
  };
  return {refusal, ""};
}

Option& Option::required(bool is) { return option_->required(is), *this; }
Option& Option::excludes(const Option& other) { return option_->excludes(other.option_), *this; }
Option& Option::check(const Check& check) { return option_->check(validator(check)), *this; }
Option& Option::sizes() {
  const auto as_bytes = [](std::string& text) {
    const auto bytes = size_of(text);
    if (!bytes)
      return quote(text) + " is not a size; accepted: bytes, or 512M, 2G and the like, up to " +
             std::to_string(kMaxBytes);
    text = std::to_string(*bytes);
    return std::string{};
  };
  return option_->transform(CLI::Validator(as_bytes, "")), *this;
}

Option& Option::one_a_time() { return option_->allow_extra_args(false), *this; }
Option& Option::shows_default() { return option_->capture_default_str(), *this; }
Option& Option::default_text(const std::string& it) { return option_->default_str(it), *this; }
Option& Option::variable(const std::string& name) { return option_->envname(name), *this; }
Option& Option::help(const std::string& text) { return option_->description(text), *this; }
Option& Option::value_name(const std::string& name) { return option_->type_name(name), *this; }
Option& Option::group(const std::string& name) { return option_->group(name), *this; }

Subcommand Subcommand::add_subcommand(const std::string& name, const std::string& about,
                                      const std::string& footer) {
  CLI::App& command = *app_->add_subcommand(name, about);
  command.footer(footer);
  return Subcommand(command);
}

template <typename Value>
Option Subcommand::option(const std::string& name, Value& value, const std::string& help) {
  Option option(*app_->add_option(name, value, help));
  if (!name.starts_with("--")) option.value_name("");  // the name says enough
  return option;
}

template Option Subcommand::option(const std::string&, std::string&, const std::string&);
template Option Subcommand::option(const std::string&, std::vector<std::string>&, const std::string&);
template Option Subcommand::option(const std::string&, std::optional<std::string>&, const std::string&);
template Option Subcommand::option(const std::string&, int&, const std::string&);
template Option Subcommand::option(const std::string&, unsigned&, const std::string&);
template Option Subcommand::option(const std::string&, std::int64_t&, const std::string&);
// std::uint64_t and std::size_t, which are not the same type on macOS.
template Option Subcommand::option(const std::string&, unsigned long&, const std::string&);
template Option Subcommand::option(const std::string&, unsigned long long&, const std::string&);
template Option Subcommand::option(const std::string&, float&, const std::string&);
template Option Subcommand::option(const std::string&, double&, const std::string&);
template Option Subcommand::option(const std::string&, std::optional<int>&, const std::string&);

Option Subcommand::flag(const std::string& name, bool& value, const std::string& help) {
  return Option(*app_->add_flag(name, value, help));
}

Option Subcommand::option(const std::string& name, const std::function<void(const std::string&)>& set,
                          const std::string& help) {
  return Option(
      *(set ? app_->add_option_function<std::string>(name, set, help) : app_->add_option(name, help)));
}

Option Subcommand::find(const std::string& name) { return Option(*app_->get_option(name)); }

void Subcommand::runs(const std::function<void()>& run) {
  exits_with([run] { return run(), 0; });
}

void Subcommand::exits_with(const std::function<int()>& run) {
  app_->callback([run] {
    try {
      if (const int status = run(); status != 0) throw CLI::RuntimeError(status);
    } catch (const UsageError& error) {
      throw CLI::ParseError(error.what(), CLI::ExitCodes::ValidationError);
    }
  });
}

void Subcommand::takes_all_words() {
  app_->set_help_flag();
  app_->prefix_command();
}

std::vector<std::string> Subcommand::words() const { return app_->remaining(); }

}  // namespace racebeam
